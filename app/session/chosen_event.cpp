#include "session/chosen_event.hpp"

namespace achilles {

namespace {

// Walks over the events and keeps count of those that could be meant.
class EventCount {
 public:
    EventCount(Event::Kind kind, const ContactSet& contacts) : kind_(kind), contacts_(contacts) {}
    bool is_meant(const Event& event) const { return event.kind == kind_ && event.contacts == contacts_; }
    void pass(const Event& event) {
        if (!event.is_impact()) ++turns;
        if (!event.is_impact() && kind_ == Event::Kind::impact) ordinal = 0;
        if (is_meant(event)) ++ordinal;
    }
    std::size_t turns = 0, ordinal = 0;

 private:
    Event::Kind kind_;
    ContactSet contacts_;
};

}  // namespace

EventMeaning meaning_of(const Trajectory& run, std::size_t event) {
    const Event& meant = run.events[event];
    EventCount count(meant.kind, meant.contacts);
    for (std::size_t i = 0; i < event; ++i) count.pass(run.events[i]);
    return {meant.kind, meant.contacts, meant.is_impact() ? count.turns : 0, count.ordinal};
}

std::optional<std::size_t> find_event(const Trajectory& run, const EventMeaning& meaning) {
    EventCount count(meaning.kind, meaning.contacts);
    for (std::size_t i = 0; i < run.events.size(); ++i) {
        const bool is_here = meaning.kind != Event::Kind::impact || count.turns == meaning.turns;
        if (is_here && count.is_meant(run.events[i]) && count.ordinal == meaning.ordinal) return i;
        count.pass(run.events[i]);
    }
    return std::nullopt;
}

}  // namespace achilles
