// The games that an ssh door offers, from the file games.list. Only the host of the door writes it; visitors
// cannot change it.
//
//   # name        link                                   visitors' socket            options
//   saucershoot   naiad://127.0.0.1#abcdefghijkl…        /run/naiad/saucer.visitors
//   tron          naiad://127.0.0.1:9877#mnopqrst…       /run/naiad/tron.visitors    password
//
// Words are separated by blanks; empty lines and lines that begin with '#' are ignored. `password`: the
// server requires one, so the visitor is asked for it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/net/stream/JoinLink.h"

namespace naiad {

struct OfferedGame {
  std::string name;  ///< 1 to 32 letters, digits, '-', '_', '.'
  JoinLink link;
  std::string socket;  ///< absolute path of the visitors' socket
  bool needs_password = false;
};

struct GamesList {
  std::vector<OfferedGame> games;
  /// Set if a line is invalid: "line 3: REASON", for the first such line. Then `games` is empty.
  std::string problem;

  static constexpr std::size_t kMaxGames = 64;

  static GamesList parse(std::string_view text);
};

}  // namespace naiad
