#include "server/directory/LobbyAnswer.h"

#include "naiad.pb.h"
#include "proto/ParseErrors.h"
#include "server/directory/ServerList.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

LobbyAnswer answerOf(LobbyAnswer::Kind kind, wire::Refused::Reason reason, const std::string& sentence,
                     const std::string& redirect = "") {
  wire::ServerMessage message;
  wire::Refused& refused = *message.mutable_refused();
  refused.set_reason(reason);
  refused.set_sentence(safeText(sentence, kMaxSentenceLength));
  refused.set_redirect(redirect);
  return {kind, message.SerializeAsString()};
}

std::string wishedGame(const std::string& game) {
  return game.empty() ? "" : " for \"" + game + "\"";
}

}  // namespace

std::optional<LobbyAnswer> answerHello(std::string_view frame, FleetList& servers) {
  silenceParseErrors();
  wire::ClientMessage message;
  if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size())) || !message.has_hello() ||
      message.hello().magic() != kHelloMagic)
    return std::nullopt;
  const wire::Hello& hello = message.hello();
  const FleetList::Wish wish{safeText(hello.game(), Presence::kMaxName), hello.protocol(), ""};
  if (const Presence* p_server = servers.choose(wish)) {
    const std::string link = linkOf(*p_server);
    return answerOf(LobbyAnswer::Kind::kSentOn, wire::Refused::REDIRECT,
                    "Nothing is played here. There is a place for you at " + link, link);
  }
  if (!servers.plays(wish)) {
    return answerOf(LobbyAnswer::Kind::kNoGame, wire::Refused::GAME,
                    "No server of this fleet" + wishedGame(wish.game) + " speaks version " +
                        std::to_string(wish.protocol) + " of the protocol, as your client does.");
  }
  return answerOf(LobbyAnswer::Kind::kNoPlace, wire::Refused::BUSY,
                  "No server" + wishedGame(wish.game) + " has a free place now.");
}

}  // namespace naiad
