#include "system/mechanism.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace achilles {

namespace {

PlanarVector derivative(const PlanarVector& vector, std::uint32_t slot) {
    PlanarVector sum;
    for (const auto& [angle, x, y] : vector.terms)
        sum = sum + PlanarVector(angle, x.derivative(slot), y.derivative(slot));
    return sum;
}

class TermDeriver {
 public:
    TermDeriver(const PlacedMechanism& mechanism, const SystemDescription& system, ErrorCollector& mistakes)
        : mechanism_(mechanism),
          symbols_(mechanism.symbols()),
          kinematics_(symbols_.kinematics()),
          graph_(symbols_.graph()),
          system_(system),
          mistakes_(mistakes) {
        result_.forces.resize(system.coordinates.size());
    }

    MechanismTerms derive() {
        add_masses();
        for (const SpringOrDamper& each : mechanism_.springs)
            attempt_part(mistakes_, each.at, each.is_damper ? "the force of this damper" : "the energy of this spring",
                         [&] { add_spring(each); });
        for (const AppliedLoad& load : mechanism_.loads)
            attempt_part(mistakes_, load.at, "this load", [&] { add_load(load); });
        return std::move(result_);
    }

 private:
    void add_masses() {
        for (const RigidBody* body : mechanism_.bodies())
            attempt_part(mistakes_, body->at, fmt::format("the energy of '{}'", body->name), [&] { add_mass(*body); });
        const Location at = drift_at_.line > 0 ? drift_at_ : mechanism_.gravity_at;
        attempt_part(mistakes_, at, "the potential of the bodies", [&] {
            add_potential(weight_, mechanism_.gravity_at);
            add_potential(-drifting_, drift_at_);
            add_inertial_forces(mixed_, drift_at_);
        });
        check_masses();
    }

    void add_mass(const RigidBody& body) {
        const ProductSum &m = body.mass, &J = body.inertia;
        if (m.is_zero() && J.is_zero()) return;
        const MovingPoint center = kinematics_.point_in(body.frame, body.center.x, body.center.y);
        const ProductSum rate = body.frame.rate.packed(), drift = body.frame.drift.packed(),
                         half = symbols_.number(1, 2);
        const ProductSum own = half * m * dot(center.velocity, center.velocity, graph_) + half * J * rate * rate;
        if (symbols_.depends_on_time(own))
            throw Mistake{body.at,
                          fmt::format("the inertia of '{}' depends on t: T = {}", body.name, shown(symbols_.text(own))),
                          "a coordinate may not move a mass in a direction that turns with t; measure it in axes that "
                          "turn as well, with 'on'"};
        if (result_.kinetic.at.line == 0) result_.kinetic.at = body.at;
        result_.kinetic.value = result_.kinetic.value + own;
        const PlanarVector gravity({}, mechanism_.gravity[0], mechanism_.gravity[1]);
        if (!gravity.is_zero()) weight_ = weight_ - m * dot(gravity, center.position, graph_);
        if (center.drift.is_zero() && drift.is_zero()) return;
        if (drift_at_.line == 0) drift_at_ = body.at;
        result_.is_prescribed = true;
        mixed_ = mixed_ + m * dot(center.velocity, center.drift, graph_) + J * rate * drift;
        drifting_ = drifting_ + half * m * dot(center.drift, center.drift, graph_) + half * J * drift * drift;
    }

    // Every coordinate must move a mass; otherwise M is singular.
    void check_masses() {
        if (mistakes_.count() > 0) return;
        for (std::size_t i = 0; i < system_.coordinates.size(); ++i) {
            const std::uint32_t slots[] = {kinematics_.rates()[i]};
            if (result_.kinetic.value.depends_on(slots)) continue;
            const std::string& name = system_.coordinates[i].name;
            mistakes_.add({system_.coordinates[i].at, fmt::format("no mass moves with '{}', so M is singular", name),
                           fmt::format("give a body whose place or angle depends on '{}' a mass or an inertia", name)});
        }
    }

    // Adds the terms that depend on coordinates, or on nothing that changes.
    void add_potential(const ProductSum& sum, const Location& at) {
        ProductSum kept;
        for (const ProductSum::Product& product : sum.products()) {
            const ProductSum term = sum.term(product);
            if (symbols_.depends_on_coordinates(term) || !symbols_.depends_on_time(term)) kept = kept + term;
        }
        if (!kept.is_zero()) result_.potential.push_back({kept, at});
    }

    void add_inertial_forces(const ProductSum& mixed, const Location& at) {
        if (mixed.is_zero()) return;
        const std::vector<std::uint32_t>&q = kinematics_.coordinates(), &v = kinematics_.rates();
        std::vector<ProductSum> c;
        for (const std::uint32_t rate : v) c.push_back(mixed.derivative(rate));
        for (std::size_t i = 0; i < v.size(); ++i) {
            ProductSum force = -c[i].derivative(kinematics_.time());
            for (std::size_t k = 0; k < v.size(); ++k)
                if (k != i)
                    force =
                        force - (c[i].derivative(q[k]) - c[k].derivative(q[i])) * ProductSum::from(graph_.symbol(v[k]));
            add_force(i, force, at);
        }
    }

    void add_force(std::size_t coordinate, const ProductSum& force, const Location& at) {
        if (!force.is_zero()) result_.forces[coordinate].push_back({force, at});
    }

    // The sum of the coordinates in the world at the start: what their difference is 0 against.
    double size_of_places(const std::array<NamedPoint, 2>& points) const {
        double size = 0.0;
        for (const NamedPoint& point : points)
            for (const ProductSum& part : components(point.point.position, {}, graph_))
                size += std::abs(symbols_.at_start(part));
        return size;
    }

    void add_spring(const SpringOrDamper& spring) {
        const ProductSum half = symbols_.number(1, 2) * spring.coefficient;
        PointDistance length;
        if (spring.between) {
            length = distance_between(mechanism_, (*spring.between)[0], (*spring.between)[1], true, spring.at);
        } else {
            length.value = spring.angle;
            length.rate = kinematics_.change_of(spring.angle);
        }
        if (!symbols_.depends_on_coordinates(length.value))
            throw Mistake{spring.at,
                          fmt::format("the {} of this {} depends on no coordinate", spring.between ? "length" : "angle",
                                      spring.is_damper ? "damper" : "spring"),
                          spring.between ? "one of its ends must move with a coordinate" : ""};
        if (spring.is_damper) {
            result_.dissipation.push_back({half * power(length.rate, 2), spring.at});
            return;
        }
        const double start = symbols_.at_start(length.value), rest = symbols_.at_start(spring.rest);
        if (spring.between && rest > 0.0 && std::abs(start) <= 1e-14 * size_of_places(*spring.between))
            throw Mistake{spring.at, "the ends of the spring meet at the start, so its direction is not defined",
                          "choose another start, or rest = 0"};
        if (spring.between && spring.rest.is_zero() && !length.is_signed) {
            const PlanarVector d = (*spring.between)[1].point.position - (*spring.between)[0].point.position;
            add_potential(half * dot(d, d, graph_), spring.at);
            return;
        }
        result_.potential.push_back({half * power(length.value - spring.rest, 2), spring.at});
    }

    void add_load(const AppliedLoad& load) {
        const PlanarVector force(load.axes.angle, load.force.x.packed(), load.force.y.packed());
        bool has_motion = false;
        for (std::size_t i = 0; i < kinematics_.rates().size(); ++i) {
            const std::uint32_t rate = kinematics_.rates()[i];
            ProductSum sum;
            if (load.point) {
                PlanarVector motion = derivative(load.point->point.velocity, rate);
                if (load.against_point) motion = motion - derivative(load.against_point->point.velocity, rate);
                has_motion = has_motion || !motion.is_zero();
                sum = dot(motion, force, graph_);
            } else {
                ProductSum turning = load.body->frame.rate.derivative(rate);
                if (load.against != nullptr) turning = turning - load.against->frame.rate.derivative(rate);
                has_motion = has_motion || !turning.is_zero();
                sum = turning * load.torque.packed();
            }
            add_force(i, sum, load.at);
        }
        if (!has_motion)
            throw Mistake{
                load.at,
                load.point ? fmt::format("'{}', where this force acts, moves with no coordinate", load.point->name)
                           : fmt::format("'{}', on which this torque acts, turns with no coordinate", load.body->name),
                {}};
    }

    const PlacedMechanism& mechanism_;
    const MechanismSymbols& symbols_;
    const Kinematics& kinematics_;
    Graph& graph_;
    const SystemDescription& system_;
    ErrorCollector& mistakes_;
    MechanismTerms result_;
    ProductSum mixed_, drifting_, weight_;  // T1, T0 and the potential of gravity
    Location drift_at_;                     // of the first mass that time moves
};

}  // namespace

MechanismTerms derive_terms(const PlacedMechanism& mechanism, const SystemDescription& system,
                            ErrorCollector& mistakes) {
    return TermDeriver(mechanism, system, mistakes).derive();
}

PointDistance distance_between(const PlacedMechanism& mechanism, const NamedPoint& from, const NamedPoint& to,
                               bool may_be_signed, const Location& at) {
    const MechanismSymbols& symbols = mechanism.symbols();
    const Kinematics& kinematics = symbols.kinematics();
    Graph& graph = symbols.graph();
    const PlanarVector d = to.point.position - from.point.position;
    // In the world's axes, or in those of a body if the whole distance is in them.
    const ProductSum axes = d.terms.size() == 1 ? d.terms.front().angle : ProductSum{};
    std::array<ProductSum, 2> part = components(d, {}, graph);
    if (!part[0].is_zero() && !part[1].is_zero()) part = components(d, axes, graph);
    if (part[0].is_zero() && part[1].is_zero())
        throw Mistake{at, fmt::format("'{}' and '{}' are always at the same place", from.name, to.name), {}};
    PointDistance result;
    if (may_be_signed && (part[0].is_zero() || part[1].is_zero())) {
        const ProductSum& along = part[0].is_zero() ? part[1] : part[0];
        result.value = symbols.at_start(along) < 0.0 ? -along : along;
        result.rate = kinematics.change_of(result.value);
        result.is_signed = true;
        return result;
    }
    result.value = symbols.positive_root(power(part[0], 2) + power(part[1], 2));
    const PlanarVector motion = to.point.motion() - from.point.motion();
    result.rate = dot(d, motion, graph).packed() / result.value;
    return result;
}

}  // namespace achilles
