#include "system/named_run.hpp"

namespace achilles {

namespace {

double& value_of(const SystemDescription& description, Run& run, std::string_view name) {
    double* const place = find_value(description, run, name);
    if (place == nullptr) throw InputError({}, {}, why_not_settable(description, name));
    return *place;
}

}  // namespace

NamedRun::NamedRun(const SystemDescription& description)
    : Run(default_run(description)), description_(std::make_shared<const SystemDescription>(description)) {}

NamedRun& NamedRun::set(std::string_view name, double value) {
    value_of(*description_, *this, name) = value;
    return *this;
}

double NamedRun::get(std::string_view name) const {
    Run copy = *this;
    return value_of(*description_, copy, name);
}

}  // namespace achilles
