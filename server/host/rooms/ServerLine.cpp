#include "host/rooms/ServerLine.h"

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

void sendServerLine(Session& session, const std::string& text) {
  wire::ServerMessage message;
  message.mutable_chat()->set_text(safeText(text, kMaxChatLength));  // without a player: the server's
  session.sendKept(message);
}

}  // namespace naiad
