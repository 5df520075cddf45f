// What the lobby of a fleet says to a client: where to go.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/directory/FleetList.h"

namespace naiad {

struct LobbyAnswer {
  enum class Kind { kSentOn, kNoPlace, kNoGame };
  Kind kind;
  std::string frame;  ///< for the client
};

/// To the first frame of a client; nothing if that is no hello. A place is taken on the server to which it is
/// sent.
std::optional<LobbyAnswer> answerHello(std::string_view frame, FleetList& servers);

}  // namespace naiad
