// The games that a door offers, from its file games.list: what its host wrote, and nothing that a visitor can
// change.
//
//   # name        link                                   visitors' socket            options
//   saucershoot   naiad://127.0.0.1#abcdefghijkl…        /run/naiad/saucer.visitors
//   tron          naiad://127.0.0.1:9877#mnopqrst…       /run/naiad/tron.visitors    password
//
// Words are separated by blanks; empty lines and those that begin with '#' are comments. `password`: the
// server wants one, so the visitor is asked for it.
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
  std::string socket;  ///< absolute path
  bool wants_password = false;
};

struct GamesList {
  std::vector<OfferedGame> games;
  /// "line 3: why", of the first line that is wrong; empty: none is. There are no games then.
  std::string problem;

  static constexpr std::size_t kMaxGames = 64;

  static GamesList parse(std::string_view text);
};

}  // namespace naiad
