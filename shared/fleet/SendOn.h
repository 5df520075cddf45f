// What a directory says to a server that is full, or nearly so: where it may send players on. Said as often
// as servers say that they are there (Presence.h) while it holds; after three times that without a word it
// does not.
//
//   naiad.sendon.ID  {"v":1,"to":"paris-9876","link":"naiad://192.0.2.8:9876/duel#…26 characters…"}
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "shared/net/stream/JoinLink.h"

namespace naiad {

struct SendOn {
  std::string to;  ///< the other server (ServerId.h)
  JoinLink link;   ///< to it, and to a room of it where it has rooms

  std::string payload() const;
  /// Nothing for what no directory writes.
  static std::optional<SendOn> parse(std::string_view payload);

  friend bool operator==(const SendOn&, const SendOn&) = default;
};

}  // namespace naiad
