// A session as a link: the address of the explorer in a browser, and after # the journal that leads to the session,
// compressed. A browser does not send that part to the server, so a server of links sees no session.
#pragma once

#include <string>
#include <string_view>

#include "session/session.hpp"

namespace achilles {

// The address of the explorer in a browser: that of the page itself or, on a desktop, the environment variable
// ACHILLES_WEB or, if that is empty, the address that `app/run web` serves.
std::string web_address();

// The link that opens the session. It contains the text of a system that is not one of the assets.
std::string link_of(const Session& session);

// True for text that carries a session behind #run=.
bool is_link(std::string_view text);

// The journal in a link, or in the part of a link after #. Throws InputError if the link holds no journal, a damaged
// one, or one that is too large. Like every journal, it may come from a stranger: read it with parse_trusted().
std::string journal_in_link(std::string_view link);

// The text of a journal given as a link, as a path or by the name of a tour. Throws InputError.
std::string text_of_journal(const std::string& journal);
// What error messages call it: its path, or "the link", which is too long for a message.
std::string name_in_messages(const std::string& journal);

}  // namespace achilles
