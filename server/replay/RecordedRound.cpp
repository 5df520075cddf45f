#include "server/replay/RecordedRound.h"

#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "host/rounds/RoundJournals.h"
#include "host/rounds/SandboxPolicy.h"
#include "host/rounds/WorldFactory.h"
#include "host/settings/GameModule.h"
#include "host/settings/HostOptions.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

/// Maximum bytes of a file: enough for days of a busy server.
constexpr std::uintmax_t kMaxRound = std::uintmax_t{1} << 30;

/// True if `name` can be that of an installed game. Refuses paths, because the file may come from a stranger.
bool isGameName(const std::string& name) {
  return !name.empty() && name.size() <= 100 && name[0] != '.' && isPlainName(name);
}

std::string quoted(const std::string& text) {
  return "\"" + safeText(text, 100) + "\"";
}

fs::path ownFolder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

/// Returns `value` if it is among the choices; otherwise the first choice.
std::string choiceOf(const std::string& value, std::initializer_list<const char*> choices) {
  const bool known =
      std::any_of(choices.begin(), choices.end(), [&](const char* one) { return value == one; });
  return known ? value : *choices.begin();
}

std::vector<std::string> variablesOf(const DfrFacts& facts) {
  std::vector<std::string> entries;
  for (const auto& [name, value] : facts) {
    if (!name.starts_with(kFactVariable)) continue;
    const std::string entry = name.substr(std::string_view(kFactVariable).size()) + "=" + value;
    if (isGameVariable(entry) && entry.find('\0') == std::string::npos) entries.push_back(entry);
  }
  return entries;
}

}  // namespace

RecordedRound::RecordedRound(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw RoundError(path.string() + ": no such file.");
  if (fs::file_size(path, error) > kMaxRound)
    throw RoundError(path.string() + ": too large for a round (limit 1 GiB).");
  std::ifstream file(path, std::ios::binary);
  m_bytes.assign(std::istreambuf_iterator<char>(file), {});
  if (!file.good() && !file.eof()) throw RoundError(path.string() + ": cannot be read.");
  const DfrReader reader(m_bytes);
  if (!reader.problem().empty()) throw RoundError(path.string() + ": " + reader.problem() + ".");
  m_header = reader.header();
  m_facts = reader.facts();
}

std::string RecordedRound::fact(const std::string& name) const {
  return factOf(m_facts, name);
}

std::unique_ptr<DfrReader> RecordedRound::read() const {
  return std::make_unique<DfrReader>(m_bytes);
}

std::vector<std::string> RecordedRound::warnings() const {
  std::vector<std::string> warnings;
  if ((m_header.flags & kDfrInProcess) != 0)
    warnings.emplace_back(
        "the game ran in the server's process: its clocks, entropy and addresses are not repeatable");
  else if (fact(kFactClocks) != "repeatable")
    warnings.emplace_back("the game's clocks and entropy are not repeatable");
  if ((m_header.flags & kDfrInProcess) == 0 && fact(kFactAddresses) != "fixed")
    warnings.emplace_back("the game's memory addresses were random");
  if ((m_header.flags & kDfrStopped) != 0) warnings.emplace_back("the recording ended before the round");
  return warnings;
}

// ---- ReplayEnvironment, which finds and starts the game ---------------------------------------------------

ReplayEnvironment::ReplayEnvironment(const RecordedRound& round, const std::string& game) : m_round(round) {
  const std::string module = findModule(game);
  std::string name = (std::filesystem::temp_directory_path() / "dfreplay-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
  m_folder = name;
  if (const std::string settings = round.fact(kFactSettings); !settings.empty())
    std::ofstream(m_folder / "df-config.txt", std::ios::binary) << settings;
  HostOptions options;
  options.players = choiceOf(round.fact(kFactPlayers), {"together", "first", "private"});
  options.on_game_over = choiceOf(round.fact(kFactGameOver), {"leave", "exit", "restart"});
  m_launcher = launchReplay(options, module, (ownFolder() / "dfserver").string(), m_folder.string(),
                            variablesOf(round.facts()));
  findDifferences();
}

ReplayEnvironment::~ReplayEnvironment() {
  m_launcher.reset();
  std::error_code ignored;
  fs::remove_all(m_folder, ignored);
}

std::string ReplayEnvironment::findModule(const std::string& game) {
  const std::string recorded = m_round.fact(kFactModule);
  const std::string name = m_round.fact(kFactGame);
  if (game.empty() && !isGameName(name)) throw RoundError("The file names no valid game; use --game.");
  if (game.empty() && recorded.empty())
    throw RoundError("The game " + quoted(name) +
                     " was a separate program, not a module; it cannot be replayed.");
  std::string module;
  try {
    module = GameModule::find(game.empty() ? name : game).string();
  } catch (const GameError& error) {
    throw RoundError(error.what());
  }
  if (hashOfModule(module) == recorded) return module;
  if (game.empty())
    throw RoundError("The installed game " + quoted(name) +
                     " differs from the recorded version; use --game to replay it anyway.");
  m_warnings.push_back(module + " differs from the recorded game");
  return module;
}

void ReplayEnvironment::findDifferences() {
  const DfrFacts here = factsOfMachine();
  for (const char* p_name : {"build libdragonfly.so", "build libc.so", "build libstdc++.so", "kernel"}) {
    const auto found = here.find(p_name);
    const std::string now = found != here.end() ? found->second : std::string();
    if (now != m_round.fact(p_name)) m_warnings.push_back(std::string(p_name) + " is not the recorded one");
  }
}

WorldStartOptions ReplayEnvironment::order() const {
  WorldStartOptions order;
  order.seed = m_round.header().seed;
  order.repeatable = true;
  order.again = true;
  order.start_nanos = m_round.header().start_nanos;
  order.frame_nanos = m_round.header().frame_nanos;
  return order;
}

}  // namespace naiad
