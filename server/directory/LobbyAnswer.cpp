#include "server/directory/LobbyAnswer.h"

#include "naiad.pb.h"
#include "proto/ParseErrors.h"
#include "server/directory/ServerList.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/RoomName.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

LobbyAnswer answerOf(LobbyAnswer::Kind kind, wire::Refused::Reason reason, const std::string& sentence,
                     const std::string& redirect = "", const std::string& room = "") {
  wire::ServerMessage message;
  wire::Refused& refused = *message.mutable_refused();
  refused.set_reason(reason);
  refused.set_sentence(safeText(sentence, kMaxSentenceLength));
  refused.set_redirect(redirect);
  refused.set_redirect_room(room);
  return {kind, message.SerializeAsString()};
}

std::string wished(const FleetList::Wish& wish) {
  return (wish.game.empty() ? "" : " for \"" + wish.game + "\"") +
         (wish.room.empty() ? "" : " with a room \"" + wish.room + "\"");
}

}  // namespace

std::optional<LobbyAnswer> answerHello(std::string_view frame, FleetList& servers) {
  silenceParseErrors();
  wire::ClientMessage message;
  if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size())) || !message.has_hello() ||
      message.hello().magic() != kHelloMagic)
    return std::nullopt;
  const wire::Hello& hello = message.hello();
  const FleetList::Wish wish{safeText(hello.game(), Presence::kMaxName), hello.protocol(), "",
                             safeText(hello.room(), kMaxRoomName)};
  if (const FleetList::Place place = servers.choose(wish)) {
    return answerOf(
        LobbyAnswer::Kind::kSentOn, wire::Refused::REDIRECT,
        "Nothing is played here. There is a place for you at " + linkOf(*place.p_server, place.room),
        linkOf(*place.p_server), place.room);
  }
  if (!servers.plays(wish)) {
    return answerOf(LobbyAnswer::Kind::kNoGame, wire::Refused::GAME,
                    "No server of this fleet" + wished(wish) + " speaks version " +
                        std::to_string(wish.protocol) + " of the protocol, as your client does.");
  }
  return answerOf(LobbyAnswer::Kind::kNoPlace, wire::Refused::BUSY,
                  "No server" + wished(wish) + " has a free place now.");
}

}  // namespace naiad
