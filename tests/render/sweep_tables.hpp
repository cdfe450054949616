// Tables of sweeps: artificial ones, and some of systems of the gallery.
#pragma once

#include <cmath>
#include <limits>

#include "figure/sweep_figure.hpp"
#include "model/read_system.hpp"
#include "render/support.hpp"

namespace achilles::sweeps {

inline constexpr double nothing_there = std::numeric_limits<double>::quiet_NaN();

// Data of an artificial table: one number and the held contacts, over a grid.
inline SweepData grid(std::vector<SweepAxis> axes, const std::vector<double>& numbers,
                      const std::vector<std::uint64_t>& signatures) {
    SweepData data;
    for (const SweepAxis& axis : axes)
        data.names.push_back(axis.name), data.units.push_back(axis.name == "e" ? "" : "m/s^2");
    data.sweep.axes = std::move(axes);
    data.columns = {{RunMeasures::Column::Kind::number, "zeno_time(2)", "s"},
                    {RunMeasures::Column::Kind::held, "held", ""}};
    data.numbers = 1;
    data.contacts = {"floor", "wall"};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        data.rows.points.push_back(i);
        data.rows.numbers.push_back(numbers[i]);
        data.rows.held.push_back(numbers[i] > 2.0 ? ContactSet::of(0) : ContactSet());
        data.rows.ends.push_back(std::isnan(numbers[i]) ? RunEnd() : RunEnd(Outcome::Kind::end_time));
        data.rows.signatures.push_back(signatures[i]);
    }
    return data;
}

inline SweepLook only(std::size_t column) {
    SweepLook look;
    look.columns = {column};
    return look;
}

inline std::shared_ptr<const Model> model_of(const std::string& system) {
    return std::make_shared<const Model>(read_system(ACHILLES_SOURCE_DIR "/assets/systems/" + system + ".toml"));
}

inline SweepData data_of(const std::string& system, const std::string& text, bool with_rows = true) {
    const auto model = model_of(system);
    const SweepTable table(model, read_sweep(text, model->description()));
    SweepData data(table);
    if (with_rows) data.add(table.rows(0, table.sweep().count()));
    return data;
}

}  // namespace achilles::sweeps
