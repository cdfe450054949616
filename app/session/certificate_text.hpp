// The certificate of a Zeno point in words and numbers for a reader: what happened, each error with its bound and what
// is allowed, and what is not covered.
#pragma once

#include <string>
#include <vector>

#include "session/session.hpp"

namespace achilles {

struct CertificateText {
    std::string title;     // "Zeno 1", "Landing of wall"
    std::string verdict;   // "CERTIFIED", "PROVED"; empty: the contact is made without a bounce
    std::string sentence;  // "It would bounce infinitely often; ..."
    struct Row {
        std::string error, bound, allowed;  // "time from the cut on", "6.9e-07 s", "1e-06 s"
        double share = 0.0;                 // bound/allowed
        bool is_nearest = false;            // the one nearest to its limit
    };
    std::vector<Row> rows;  // empty: nothing had to be decided
    std::string not_covered;
};
// Of an event with a certificate.
CertificateText certificate_text(const Session& session, std::size_t event);

// The bounds of the certificate line by line, for the details. The Zeno time is not among them: event_time() has it.
std::vector<std::string> certificate_lines(const Event& event);

// "9th", "21st".
std::string ordinal(int number);
// "1.6 ms": a duration in the unit that suits it, with two digits.
std::string duration_text(double seconds);

}  // namespace achilles
