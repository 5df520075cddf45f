// The list of games of an ssh door: each line that is not a comment is a game, or else the whole list is
// invalid. A valid list is equal after being written and read again.
//
//   input   the file
#include <algorithm>

#include "Target.h"
#include "client/door/GamesList.h"

namespace naiad::fuzz {
namespace {

constexpr const char* kBlanks = " \t\v\f\r";

std::size_t linesWithGames(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    const std::size_t first = line.find_first_not_of(kBlanks);
    if (first != std::string_view::npos && line[first] != '#') ++count;
    at = end + 1;
  }
  return count;
}

void requireGame(const OfferedGame& game) {
  REQUIRE(!game.name.empty() && game.name.size() <= 32);
  REQUIRE(std::ranges::all_of(game.name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  }));
  REQUIRE(game.socket.starts_with('/'));
}

bool isSame(const OfferedGame& one, const OfferedGame& other) {
  return one.name == other.name && one.link == other.link && one.socket == other.socket &&
         one.needs_password == other.needs_password;
}

}  // namespace

void tryInput(Script script) {
  const std::string text = script.rest();
  const GamesList list = GamesList::parse(text);
  if (!list.problem.empty()) {
    REQUIRE(list.games.empty() && list.problem.starts_with("line "));
    return;
  }
  REQUIRE(list.games.size() == linesWithGames(text));
  REQUIRE(list.games.size() <= GamesList::kMaxGames);
  std::string written;
  for (const OfferedGame& game : list.games) {
    requireGame(game);
    written +=
        game.name + " " + game.link.text() + " " + game.socket + (game.needs_password ? " password\n" : "\n");
  }
  const GamesList again = GamesList::parse(written);
  REQUIRE(std::ranges::equal(again.games, list.games, isSame));
}

}  // namespace naiad::fuzz
