// Chat lines from the server to one player.
#pragma once

#include <string>

#include "host/session/Session.h"

namespace naiad {

/// Sends a chat line from the server, cut to kMaxChatLength characters. Thread: the host's.
void sendServerLine(Session& session, const std::string& text);

}  // namespace naiad
