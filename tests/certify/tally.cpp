#include "certify/tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "certify/definition7.hpp"

namespace achilles::test {

void Tally::add(const Trial& trial, const CertificateCase& certified, const Model& model) {
    ++certificates;
    if (!trial.zeno) {
        ++unknown;
        return;
    }
    bool violated = false;
    for (const Claim& claim : claims(trial, certified)) {
        violated = violated || !claim.holds();
        const double ratio = claim.bound / claim.actual;
        if (!(claim.actual > 0.0)) continue;
        if (claim.about == Claim::ClaimKind::latest) ratios[latest].push_back(ratio);
        if (claim.about == Claim::ClaimKind::position) ratios[position].push_back(ratio);
        if (claim.about == Claim::ClaimKind::velocity) ratios[velocity].push_back(ratio);
        if (claim.about == Claim::ClaimKind::shadowing_velocity) ratios[shadowing].push_back(ratio);
        if (claim.about == Claim::ClaimKind::uniform_position) ratios[uniform].push_back(ratio);
    }
    const double half_width = 0.5 * (certified.certificate.zeno_high - certified.certificate.zeno_low);
    if (certified.best && half_width > 0.0) {
        ++estimates;
        const double error = std::abs(static_cast<double>(trial.zeno->point.t - *certified.best));
        worst_estimate = std::max(worst_estimate, error / half_width);
    }
    if (certified.asked.conditions == Conditions::paper) {
        const double far = largest_excursion(trial, certified.asked.reinitialization);
        const double added = certified.asked.eps_v / certified.certificate.paper->c3 *
                             trial.restarted(certified.asked.reinitialization).collision.speed;
        if (far > 0.0) ratios[excursion].push_back(added / far);
        Run run = trial.run;
        run.options.truncation = certified.asked;
        const Collision& collision = trial.restarted(certified.asked.reinitialization).collision;
        const double least =
            Definition7(model, run, trial.contact, trial.mode).at(collision).velocity * collision.speed;
        ratios[formula].push_back(added / least);
    }
    if (violated) ++violations;
}

double Tally::median(Ratio ratio) const {
    std::vector<double> sorted = ratios[ratio];
    if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

double Tally::least(Ratio ratio) const {
    const auto found = std::min_element(ratios[ratio].begin(), ratios[ratio].end());
    return found == ratios[ratio].end() ? std::numeric_limits<double>::quiet_NaN() : *found;
}

void add(Tallies& tallies, const Trial& trial, const Model& model) {
    for (const CertificateCase& certified : trial.certified)
        tallies[{certified.asked.conditions, certified.asked.reinitialization, certified.held}].add(trial, certified,
                                                                                                    model);
}

std::string table_head() {
    return fmt::format("{:<24}{:<6}{:<10}{:<7}{:>7}{:>6}{:>5}{:>8}{:>9}{:>9}{:>9}{:>9}{:>10}{:>9}{:>9}{:>10}{:>9}\n",
                       "system", "", "restart", "", "proved", "false", "n/a", "time", "position", "velocity",
                       "farthest", "formula", "shadowing", "uniform", "least", "estimates", "worst");
}

std::string table_rows(const std::string& system, const Tallies& tallies) {
    std::string rows;
    for (const auto& [key, tally] : tallies) {
        const auto [conditions, kind, held] = key;
        rows += fmt::format("{:<24}{:<6}{:<10}{:<7}{:>7}{:>6}{:>5}{:>8.4f}", system,
                            conditions == Conditions::paper ? "paper" : "sharp",
                            kind == Reinitialization::kinetic ? "kinetic" : "euclidean", held ? "holds" : "widest",
                            tally.certificates, tally.violations, tally.unknown, tally.median(Tally::latest));
        rows += fmt::format("{:>9.2f}{:>9.2f}", tally.median(Tally::position), tally.median(Tally::velocity));
        const bool paper = conditions == Conditions::paper;
        rows += paper ? fmt::format("{:>9.2f}{:>9.3f}{:>10}", tally.median(Tally::excursion),
                                    tally.median(Tally::formula), "")
                      : fmt::format("{:>18}{:>10.2f}", "", tally.median(Tally::shadowing));
        rows += fmt::format("{:>9.3f}{:>9.5f}{:>10}{:>9.4f}\n", tally.median(Tally::uniform),
                            tally.least(Tally::uniform), tally.estimates, tally.worst_estimate);
    }
    return rows;
}

}  // namespace achilles::test
