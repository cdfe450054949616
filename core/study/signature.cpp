#include "study/signature.hpp"

#include <algorithm>
#include <bit>

namespace achilles {

RunEnd RunEnd::from(std::uint8_t code) {
    RunEnd end;
    end.code_ = std::min<std::uint8_t>(code, 1 + static_cast<std::uint8_t>(Outcome::Kind::cancelled));
    return end;
}

std::string_view RunEnd::text() const {
    return code_ == 0 ? "cannot start" : to_text(static_cast<Outcome::Kind>(code_ - 1));
}

std::uint64_t signature_of(std::span<const Passage> sequence, RunEnd end) {
    std::uint64_t hash = mixed(end.code());
    ContactSet settling;  // that come to rest before anything else happens
    for (std::size_t i = sequence.size(); i-- > 0;) {
        const Passage& passage = sequence[i];
        if (passage.is_zeno())
            settling = settling.with(passage.contacts);
        else if (passage.is_impact() && passage.contacts.without(settling).empty())
            continue;
        else
            settling = {};
        hash = mixed(hash ^ std::bit_cast<std::uint32_t>(passage.contacts));
        hash = mixed(hash ^ static_cast<std::uint64_t>(passage.kind));
    }
    return hash;
}

}  // namespace achilles
