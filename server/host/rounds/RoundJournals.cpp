#include "host/rounds/RoundJournals.h"

#include <openssl/evp.h>
#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "host/auth/Seed.h"
#include "host/journal/DfrWriter.h"
#include "host/journal/RoundRecovery.h"
#include "host/journal/Salvage.h"
#include "host/process/TickClock.h"
#include "host/rounds/SandboxPolicy.h"
#include "host/settings/GameModule.h"
#include "host/world/BuildId.h"
#include "host/world/Determinism.h"
#include "shared/net/base/SafeFile.h"
#include "shared/net/base/SafeText.h"
#include "shared/values/Version.h"

namespace naiad {

namespace {

bool isInstalled(const std::string& game, const std::filesystem::path& module) {
  try {
    return GameModule::find(game) == module;
  } catch (const GameError&) {
    return false;
  }
}

namespace fs = std::filesystem;

/// Bytes of turns that may wait for the disk: of a shared world (a thousand players for 20 seconds), of a
/// room, and of a single player's world.
constexpr std::size_t kSharedRing = std::size_t{4} << 20;
constexpr std::size_t kRoomRing = std::size_t{1} << 20;
constexpr std::size_t kPrivateRing = std::size_t{256} << 10;

/// Maximum number of attempts to resume one round: if the server dies during one, the round may be the cause.
constexpr int kMaxAttempts = 3;

std::string readSettings() {
  const char* p_named = std::getenv("DRAGONFLY_CONFIG");
  const fs::path path = p_named != nullptr ? p_named : "df-config.txt";
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > kMaxSettings) return {};
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string hexNumber(std::uint64_t number) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(number));
  return text;
}

/// Suggests dfreplay only for modules: it cannot execute games that are programs.
std::string describeLastDeath(const std::string& path, std::uint32_t tick, const std::string& game,
                              const std::string& module) {
  if (module.empty())
    return " again; the recording of the round is " + path + ", where this is tick " + std::to_string(tick);
  return " again; to see where: " + debugCommand(path, tick, game, module);
}

DfrFacts factsOfStart(const WorldProcess& world) {
  DfrFacts facts;
  facts[kFactFirstTick] = std::to_string(world.nextTick());
  if (!world.ready()) return facts;
  facts[kFactAddresses] = world.ready()->fixed_addresses ? "fixed" : "random";
  for (const ReadFile& file : world.ready()->files) facts[kFactFile + file.name] = hexNumber(file.hash);
  return facts;
}

std::string notRecovered(const std::string& why) {
  return "cannot recover the round: " + why;
}

/// Returns the start times and files of the rounds of a port's servers, newest first. Adds a line to `said`
/// for each file that cannot be read. Searches the first kBeginning bytes of each file for the port, and also
/// returns the rounds in which it finds none.
std::vector<std::pair<std::uint64_t, fs::path>> roundsOf(const std::string& folder, const std::string& port,
                                                         std::vector<std::string>& said) {
  constexpr std::size_t kBeginning = 65'536;
  std::vector<std::pair<std::uint64_t, fs::path>> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() != ".dfr") continue;
    try {
      const std::string bytes = readTrustedStart(entry.path(), kBeginning);
      const DfrReader reader(bytes);
      const std::string fact = factOf(reader.facts(), kFactPort);
      if (!reader.problem().empty())
        said.push_back(notRecovered(entry.path().string() + ": " + reader.problem()));
      else if (fact.empty() || fact == port)
        found.emplace_back(reader.header().start_nanos, entry.path());
    } catch (const std::system_error& error) {
      said.push_back(notRecovered(error.what()));
    }
  }
  std::sort(found.rbegin(), found.rend());
  return found;
}

/// Returns why this server cannot play the round as it was, in words; empty if it can.
std::string differenceOf(const UnfinishedRound& round, const DfrFacts& expected, std::uint64_t frame_nanos,
                         const HandedOverRounds& kept) {
  if ((round.header().flags & kDfrStopped) != 0) return "its journal is incomplete";
  if ((round.header().flags & kDfrInProcess) != 0) return "the game ran in the server's own process";
  if (round.fact(kFactRepeatable) == "no") return "the game is not repeatable";
  if (round.header().frame_nanos != frame_nanos) return "its ticks have a different length";
  if (round.fact(kFactClocks) != "repeatable") return "its clocks were not repeatable";
  const auto proven = kept.find(uuidText(round.header().uuid));
  for (const char* p_name : {kFactModule, kFactPlayers, kFactGameOver, kFactSettings, kFactClocks}) {
    const std::string value = factOf(expected, p_name);
    const bool is_proven =
        proven != kept.end() && std::string_view(p_name) == kFactModule && value == proven->second;
    if (round.fact(p_name) != value && !is_proven)
      return "its value of " + std::string(p_name) + " differs from this server's";
  }
  for (const auto& [name, value] : expected) {
    if (name.starts_with(kFactVariable) && round.fact(name) != value)
      return "its value of " + name + " differs from this server's";
  }
  return {};
}

/// Returns the number of attempts to resume the round from its present end. A successful one adds a turn.
int attemptsOf(const UnfinishedRound& round) {
  std::istringstream fact(round.fact(kFactAttempts));
  int attempts = 0;
  std::uint32_t turns = 0;
  return fact >> attempts >> turns && turns >= round.turns() ? attempts : 0;
}

/// Environment variable that names the handed-over rounds. Not an option, because it is for a single start.
constexpr const char* kHandoverVariable = "DF_KEPT_ROUNDS";

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

// Considers only the newest round of this game and port, because players have left the older ones.
std::unique_ptr<UnfinishedRound> findUnfinishedRound(const std::string& folder, const DfrFacts& expected,
                                                     std::uint64_t frame_nanos,
                                                     std::vector<std::string>& said,
                                                     const HandedOverRounds& kept) {
  for (const auto& [start, path] : roundsOf(folder, expected.at(kFactPort), said)) {
    try {
      auto round = std::make_unique<UnfinishedRound>(path.string());
      const std::string game = round->fact(kFactGame);
      const std::string port = round->fact(kFactPort);
      const bool is_of_this_game = game == expected.at(kFactGame);
      if (!port.empty() && port != expected.at(kFactPort)) continue;  // a round of another server
      if (round->isOver() && is_of_this_game) return nullptr;
      if (round->isOver()) continue;
      const std::string reason = port.empty()          ? "truncated before its first tick"
                                 : !is_of_this_game    ? "a round of the game " + safeText(game, kMaxDfrName)
                                 : round->turns() == 0 ? "no tick of it is complete"
                                                       : differenceOf(*round, expected, frame_nanos, kept);
      if (!reason.empty()) said.push_back(notRecovered(path.string() + ": " + reason));
      if (port.empty() || !is_of_this_game) continue;
      if (!reason.empty()) return nullptr;
      std::error_code ignored;
      if (const auto size = fs::file_size(path, ignored); !ignored && size > round->wholeBytes())
        said.push_back("ticks of the round are lost, because the last " +
                       std::to_string(size - round->wholeBytes()) + " bytes of " + path.string() +
                       " are damaged or incomplete");
      return round;
    } catch (const UnfinishedRoundError& error) {
      said.push_back(notRecovered(path.string() + ": " + error.what()));
    }
  }
  return nullptr;
}

std::string hashOfModule(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EVP_MD_CTX* p_context = EVP_MD_CTX_new();
  bool good = file.good() && p_context != nullptr && EVP_DigestInit_ex(p_context, EVP_sha256(), nullptr) == 1;
  std::array<char, 65'536> part{};
  while (good && file.read(part.data(), part.size()).gcount() > 0)
    good = EVP_DigestUpdate(p_context, part.data(), static_cast<std::size_t>(file.gcount())) == 1;
  unsigned char hash[EVP_MAX_MD_SIZE];
  unsigned size = 0;
  good = good && EVP_DigestFinal_ex(p_context, hash, &size) == 1;
  EVP_MD_CTX_free(p_context);
  return good ? hexText({hash, size}) : std::string();
}

DfrFacts factsOfMachine() {
  DfrFacts facts;
  utsname system{};
  if (uname(&system) == 0) facts["kernel"] = std::string(system.release) + " " + system.machine;
  for (const char* p_library : {"libdragonfly.so", "libc.so", "libstdc++.so"})
    facts["build " + std::string(p_library)] = buildIdOf(p_library);
  return facts;
}

std::shared_ptr<RoundJournals> RoundJournals::open(const HostOptions& options, const std::string& game,
                                                   const std::string& module, const LogLine& log) {
  return usesJournal(options) ? std::make_shared<RoundJournals>(options, game, module, log) : nullptr;
}

RoundJournals::RoundJournals(const HostOptions& options, std::string game, const std::string& module,
                             LogLine log, std::shared_ptr<SharedJournals> p_shared)
    : m_folder(fs::absolute(options.journal).string()),
      m_of_room(p_shared != nullptr),
      m_game(std::move(game)),
      m_module(module),
      m_seed(options.seed),
      m_frame_nanos(static_cast<std::uint64_t>(
          std::chrono::nanoseconds(TickLength::fromMicros(options.frame_micros).times(1)).count())),
      m_ring(options.players == "private" ? kPrivateRing
             : p_shared != nullptr        ? kRoomRing
                                          : kSharedRing),
      m_facts(factsOfMachine()),
      m_log(std::move(log)),
      m_is_private(options.players == "private"),
      m_recovers(options.recover == "on"),
      m_shared(p_shared != nullptr ? std::move(p_shared) : std::make_shared<SharedJournals>()) {
  m_facts[kFactGame] = m_game;
  m_facts[kFactVersion] = kVersion;
  m_facts[kFactPort] = std::to_string(options.port);
  m_facts[kFactPlayers] = options.players;
  m_facts[kFactGameOver] = options.on_game_over;
  m_facts[kFactClocks] = determinismPreload().empty() ? "real" : "repeatable";
  if (!module.empty()) m_facts[kFactModule] = hashOfModule(module);
  if (const std::string settings = readSettings(); !settings.empty()) m_facts[kFactSettings] = settings;
  for (const std::string& entry : makeFixedEnvironment(options)) {
    const std::size_t equals = entry.find('=');
    if (isGameVariable(entry)) m_facts[kFactVariable + entry.substr(0, equals)] = entry.substr(equals + 1);
  }
  std::set<std::string> left;
  for (const auto& [uuid, hash] : m_shared->kept) left.insert(uuid);
  for (const std::string& sentence : salvageRounds(m_folder, left)) m_log(sentence);
  findRound(options);
  m_log({LogEvent::Level::kDebug, "recording rounds in " + m_folder});
  if (determinismPreload().empty())
    m_log("warning: libdragonfly-repeat.so is missing: games that read a clock cannot be replayed");
}

WorldStartOptions RoundJournals::makeStartOptions() const {
  WorldStartOptions order;
  order.seed = m_seed != 0 ? static_cast<std::uint64_t>(m_seed) : newSeed();
  order.repeatable = true;
  order.copies = !m_is_private;
  order.start_nanos = static_cast<std::uint64_t>(
      std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count());
  order.frame_nanos = m_frame_nanos;
  return order;
}

std::string RoundJournals::pathOf(const DfrHeader& header) const {
  const auto seconds = static_cast<std::time_t>(header.start_nanos / 1'000'000'000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char when[32];
  std::strftime(when, sizeof when, "%Y%m%d-%H%M%S", &utc);
  return m_folder + "/" + m_game + "-" + when + "-" + uuidText(header.uuid).substr(0, 8) + ".dfr";
}

void RoundJournals::findRound(const HostOptions& options) {
  if (options.recover != "on") return;
  std::vector<std::string> said;
  m_open = findUnfinishedRound(m_folder, m_facts, m_frame_nanos, said, m_shared->kept);
  if (m_open != nullptr && options.players == "private") {
    said.push_back(notRecovered(m_open->path() + ": rounds of --input-mode private are not recovered"));
    m_open.reset();
  }
  // Players reconnect within the grace time, and a file is written once a second.
  const auto patience = std::chrono::duration<double>(options.grace) + JournalWriter::kFlushInterval;
  if (m_open != nullptr && std::filesystem::file_time_type::clock::now() - m_open->writtenAt() > patience)
    m_open->dropSessions();
  for (const std::string& line : said) m_log(LogEvent::warning(line));
}

std::optional<WorldStartOptions> RoundJournals::resumeOptions() const {
  if (m_open == nullptr) return std::nullopt;
  WorldStartOptions order = makeStartOptions();
  order.seed = m_open->header().seed;
  order.again = true;  // otherwise a game that sleeps would replay in real time
  order.start_nanos = m_open->header().start_nanos;
  order.frame_nanos = m_open->header().frame_nanos;
  return order;
}

// Records the attempt in the file before it begins, so a round that repeatedly ends the server is given up.
std::shared_ptr<Journal> RoundJournals::resumeJournal(UnfinishedRound& round) const {
  auto sink = std::make_unique<JournalFileSink>(round.path(), round.wholeBytes());
  const int attempts = attemptsOf(round);
  if (attempts >= kMaxAttempts) {
    sink->write(encodeDfrDone("given up: recovery failed " + std::to_string(attempts) + " times"));
    sink->sync();
    m_log({LogEvent::Level::kError, "giving up on the round " + round.path() + " after " +
                                        std::to_string(attempts) + " failed recoveries; starting a new one"});
    return nullptr;
  }
  sink->write(
      encodeDfrMeta({{kFactAttempts, std::to_string(attempts + 1) + " " + std::to_string(round.turns())}}));
  sink->sync();
  return std::make_shared<Journal>(std::move(sink), round.header(), DfrFacts(), m_ring, true,
                                   round.releasePosition(), ringFolder(m_folder));
}

std::unique_ptr<Round> RoundJournals::resumeRound(std::unique_ptr<WorldProcess> world, NewWorld another) {
  const auto round = std::shared_ptr<UnfinishedRound>(std::move(m_open));
  const std::string path = round->path();
  Round::JournalBinding book = makeBinding(path, *world);
  try {
    book.journal = resumeJournal(*round);
  } catch (const std::system_error& error) {
    m_log({LogEvent::Level::kError, "cannot recover the round: " + std::string(error.what())});
  }
  if (book.journal == nullptr) return nullptr;
  const bool is_kept = isHandedOver(*round);
  if (is_kept) book.journal->addFacts(m_facts);  // from now on this server's game plays the round
  if (!is_kept)
    book.find_difference = [p_world = world.get(), round] {
      for (const auto& [name, value] : factsOfStart(*p_world)) {
        const std::string before = round->fact(name);
        if (name.starts_with(kFactFile) && !before.empty() && before != value)
          return "it reads a different " + name + " than before";
      }
      return std::string();
    };
  book.on_recovered = [log = m_log, path, began = std::chrono::steady_clock::now()](
                          std::uint32_t ticks, const std::string& problem) {
    if (!problem.empty()) {
      log({LogEvent::Level::kError, "cannot recover the round " + path + ": " + problem});
      return;
    }
    const auto took =
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - began);
    log("round recovered: replayed " + std::to_string(ticks) + " ticks in " + std::to_string(took.count()) +
        " ms");
  };
  m_log((is_kept ? "replaying the round that was handed over: "
                 : "the previous server was killed; replaying its round: ") +
        path);
  book.history = round->records();
  book.first_tick = readNumber(round->fact(kFactFirstTick), 0u, UINT32_MAX).value_or(0);
  book.new_world = std::move(another);
  book.recovery = std::make_unique<RoundRecovery>(round);
  beginWriting(book.journal, path);
  return std::make_unique<Round>(std::move(world), std::move(book));
}

Round::JournalBinding RoundJournals::makeBinding(const std::string& path, const WorldProcess& world) const {
  Round::JournalBinding book;
  book.writer = m_shared->writer;
  const fs::path file(path);
  book.recording = (m_of_room ? file.parent_path().filename() / file.filename() : file.filename()).string();
  book.late_facts = [&world] { return factsOfStart(world); };
  book.on_problem = [log = m_log, path](const std::string& problem) {
    log({LogEvent::Level::kError,
         "no longer recording the round, which continues: " + problem + " (" + path + ")"});
  };
  book.on_failure = [log = m_log, path, game = m_game, module = m_module](const WorldEnd& end,
                                                                          std::uint32_t tick, bool goes_on) {
    log({LogEvent::Level::kError, "the game " + end.text + (end.when.empty() ? "" : " " + end.when) +
                                      (goes_on ? "; recovering it without the input of that tick"
                                               : describeLastDeath(path, tick, game, module))});
    for (const std::string& line : end.last_lines) log("the game's log: " + line);
  };
  book.on_failover = [log = m_log](const Failover& done, std::chrono::milliseconds time) {
    log(std::string("game recovered: ") + (done.by_checkpoint ? "a copy of its world" : "a new world") +
        " replayed " + std::to_string(done.ticks) + " ticks in " + std::to_string(time.count()) + " ms");
  };
  book.on_copies = [log = m_log](const std::string& sentence) { log(sentence); };
  return book;
}

std::unique_ptr<Round> RoundJournals::recordWorld(std::unique_ptr<WorldProcess> world,
                                                  const WorldStartOptions& order,
                                                  DeterminismCheck::NewWorld again, NewWorld another) {
  DfrHeader header;
  std::random_device device;
  for (std::uint8_t& byte : header.uuid) byte = static_cast<std::uint8_t>(device());
  header.seed = order.seed;
  header.start_nanos = order.start_nanos;
  header.frame_nanos = order.frame_nanos;
  const std::string path = pathOf(header);
  Round::JournalBinding book = makeBinding(path, *world);
  try {
    book.journal =
        std::make_shared<Journal>(std::make_unique<JournalFileSink>(path), header, m_facts, m_ring, true,
                                  std::nullopt, ringFolder(m_folder), fs::path(path).filename().string());
  } catch (const std::system_error& error) {
    m_log({LogEvent::Level::kError, "not recording this round: " + std::string(error.what())});
    return std::make_unique<Round>(std::move(world));
  }
  book.new_world = std::move(another);
  if (again && m_shared->checked.insert(m_game).second) {
    book.check = std::make_unique<DeterminismCheck>(
        std::move(again),
        [log = m_log, journal = book.journal, repeats = m_is_deterministic](const std::string& sentence) {
          *repeats = false;
          journal->addFacts({{kFactRepeatable, "no"}});
          log(LogEvent::warning(sentence));
        });
  }
  beginWriting(book.journal, path);
  m_shared->writer->wake();  // so that the file exists if the server is killed within a second
  return std::make_unique<Round>(std::move(world), std::move(book));
}

// ---- handover to another program --------------------------------------------------------------------------

HandedOverRounds importHandedOverRounds() {
  HandedOverRounds rounds;
  const char* p_value = std::getenv(kHandoverVariable);
  std::istringstream words(p_value != nullptr ? p_value : "");
  for (std::string uuid, hash; words >> uuid >> hash;) rounds[uuid] = hash;
  unsetenv(kHandoverVariable);
  return rounds;
}

void RoundJournals::exportHandedOverRounds(const HandedOverRounds& rounds) {
  std::ostringstream text;
  for (const auto& [uuid, hash] : rounds) text << uuid << ' ' << hash << ' ';
  setenv(kHandoverVariable, text.str().c_str(), 1);
}

void RoundJournals::beginWriting(const std::shared_ptr<Journal>& journal, const std::string& file) {
  m_shared->writer->add(journal);
  m_current = journal;
  m_current_file = file;
}

std::optional<RoundJournals::CurrentRound> RoundJournals::currentRound() const {
  const auto journal = m_current.lock();
  if (journal == nullptr || !journal->isOpen()) return std::nullopt;
  return CurrentRound{uuidText(journal->header().uuid), m_current_file, journal->header().start_nanos};
}

std::string RoundJournals::handoverBlocker() const {
  if (m_is_private) return "each player has a separate world";
  if (!m_recovers) return "--recover is off";
  if (m_module.empty()) return "the game is a program, not a module";
  if (!*m_is_deterministic) return "the game is not repeatable";
  const auto journal = m_current.lock();
  if (journal != nullptr && journal->hasStopped()) return "its journal has stopped";
  return factOf(m_facts, kFactClocks) != "repeatable" ? "the game's clocks are not repeatable" : "";
}

void RoundJournals::suspend() {
  if (const auto journal = m_current.lock()) journal->suspend();
}

bool RoundJournals::isHandedOver(const UnfinishedRound& round) const {
  return m_shared->kept.contains(uuidText(round.header().uuid));
}

}  // namespace naiad
