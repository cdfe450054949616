// The energies along a run.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "output/contacts.hpp"
#include "session/session.hpp"

namespace achilles {

// The energies along the run that is shown, computed once per run.
class EnergyCourse {
 public:
    // Computes the energies of the run. is_of() tells whether they still belong to it.
    explicit EnergyCourse(const Session& session)
        : model_(session.model()),
          run_(session.trajectory().run),
          end_(session.trajectory().end_time),
          balance_(*model_, run_) {
        for (const Sample& sample : session.samples()) {
            const Energies now = balance_.at(sample);
            lowest_ = course_.empty() ? now.potential : std::min(lowest_, now.potential);
            course_.emplace_back(sample.t, now);
        }
        for (const auto& [t, energies] : course_) full_ = std::max(full_, stack(energies).back());
    }
    bool is_of(const Session& session) const {
        return model_ == session.model() && end_ == session.trajectory().end_time && run_ == session.trajectory().run;
    }
    Energies at(const Sample& sample) { return balance_.at(sample); }
    // The energies of the last sample before a time, as in the curves.
    const Energies& before(double t) const {
        const auto after = std::upper_bound(course_.begin(), course_.end(), t,
                                            [](double at, const auto& entry) { return at < entry.first; });
        return after == course_.begin() ? after->second : std::prev(after)->second;
    }
    bool empty() const { return course_.empty(); }
    // Upper ends of the stacked parts: kinetic energy, potential energy above its minimum, impact losses, heat of
    // friction, work of forces.
    using Stack = std::array<double, 5>;
    Stack stack(const Energies& now) const {
        Stack ends{};
        ends[0] = now.kinetic;
        ends[1] = ends[0] + now.potential - lowest_;
        ends[2] = ends[1] + now.loss;
        ends[3] = ends[2] + now.heat;
        ends[4] = ends[3] + (now.work < 0.0 ? -now.work : 0.0);
        return ends;
    }
    double full() const { return full_; }
    double at_start() const { return course_.front().second.total() - lowest_; }

 private:
    std::shared_ptr<const Model> model_;
    Run run_;
    double end_;
    EnergyBalance balance_;
    std::vector<std::pair<double, Energies>> course_;
    double lowest_ = 0.0, full_ = 0.0;
};

}  // namespace achilles
