#include "client/door/GamesList.h"

#include <sstream>
#include <variant>

#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

constexpr std::size_t kMaxName = 32;

/// Parses the words of a line into `game`. Returns what is wrong with them; empty if nothing is.
std::string readWords(const std::vector<std::string>& words, std::optional<OfferedGame>& game) {
  if (words.size() < 3 || words.size() > 4) return "expected NAME LINK SOCKET [password]";
  if (words[0].size() > kMaxName || !isPlainName(words[0]))
    return "invalid name: expected at most 32 letters, digits, '-', '_' and '.'";
  const auto parsed = JoinLink::parse(words[1]);
  if (const auto* p_problem = std::get_if<LinkError>(&parsed)) return "invalid link: " + p_problem->message;
  if (!words[2].starts_with('/')) return "the path of the visitors' socket does not begin with /";
  if (words.size() == 4 && words[3] != "password") return "the only option is \"password\"";
  game = OfferedGame{words[0], std::get<JoinLink>(parsed), words[2], words.size() == 4};
  return {};
}

}  // namespace

GamesList GamesList::parse(std::string_view text) {
  GamesList list;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream blanks(line);
    std::vector<std::string> words;
    for (std::string word; blanks >> word;) words.push_back(word);
    if (words.empty() || words[0].starts_with('#')) continue;
    std::optional<OfferedGame> game;
    std::string wrong = readWords(words, game);
    if (wrong.empty() && list.games.size() == kMaxGames) wrong = "there are more than 64 games";
    if (!wrong.empty()) return {{}, "line " + std::to_string(number) + ": " + wrong};
    list.games.push_back(*game);
  }
  return list;
}

}  // namespace naiad
