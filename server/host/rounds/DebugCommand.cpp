#include "host/rounds/DebugCommand.h"

#include <string_view>

#include "host/settings/GameModule.h"

namespace naiad {

namespace {

bool isInstalled(const std::string& game, const std::filesystem::path& module) {
  try {
    return GameModule::find(game) == module;
  } catch (const GameError&) {
    return false;
  }
}

}  // namespace

std::string shellWord(const std::string& text) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text) c == '\'' ? word += "'\\''" : word += c;
  return word + "'";
}

std::string debugCommand(const std::string& file, std::uint32_t tick, const std::string& game,
                         const std::filesystem::path& module) {
  std::string line = "dfreplay " + shellWord(file) + " --until " + std::to_string(tick) + " --debug";
  if (!isInstalled(game, module)) line += " --game " + shellWord(module.string());
  return line;
}

}  // namespace naiad
