// A run whose values are set by their names, as --set does.
#pragma once

#include <memory>
#include <string_view>

#include "description.hpp"

namespace achilles {

class NamedRun : public Run {
 public:
    // The run that the description asks for.
    explicit NamedRun(const SystemDescription& description);

    // Sets a parameter, a coordinate x or its rate x' at the start; angles in rad. Throws InputError where there is no such name,
    // with what was probably meant. May be chained.
    NamedRun& set(std::string_view name, double value);
    // Its value. Throws as set() does.
    double get(std::string_view name) const;

 private:
    std::shared_ptr<const SystemDescription> description_;
};

}  // namespace achilles
