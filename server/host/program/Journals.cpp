#include "host/program/Journals.h"

#include <openssl/evp.h>
#include <sys/utsname.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <system_error>
#include <utility>

#include "host/auth/Seed.h"
#include "host/journal/Salvage.h"
#include "host/program/TickClock.h"
#include "host/program/WorldSandbox.h"
#include "host/world/Repeatable.h"
#include "shared/program/BuildId.h"
#include "shared/values/Version.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

/// Bytes of turns that may wait for a disk: of a thousand players for 20 seconds, and of one alone.
constexpr std::size_t kSharedRing = std::size_t{4} << 20;
constexpr std::size_t kPrivateRing = std::size_t{256} << 10;

std::string hexOf(const unsigned char* p, std::size_t count) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text.push_back(kDigits[p[i] >> 4]);
    text.push_back(kDigits[p[i] & 15]);
  }
  return text;
}

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

DfrFacts factsOfStart(const WorldProcess& world) {
  DfrFacts facts;
  if (!world.ready()) return facts;
  facts[kFactAddresses] = world.ready()->fixed_addresses ? "fixed" : "random";
  for (const ReadFile& file : world.ready()->files) facts[kFactFile + file.name] = hexNumber(file.hash);
  return facts;
}

}  // namespace

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
  return good ? hexOf(hash, size) : std::string();
}

DfrFacts factsOfMachine() {
  DfrFacts facts;
  utsname system{};
  if (uname(&system) == 0) facts["kernel"] = std::string(system.release) + " " + system.machine;
  for (const char* p_library : {"libdragonfly.so", "libc.so", "libstdc++.so"})
    facts["build " + std::string(p_library)] = buildIdOf(p_library);
  return facts;
}

std::shared_ptr<Journals> Journals::open(const HostOptions& options, const std::string& game,
                                         const std::string& module, const LogLine& log) {
  return wantsJournal(options) ? std::make_shared<Journals>(options, game, module, log) : nullptr;
}

Journals::Journals(const HostOptions& options, std::string game, const std::string& module, LogLine log)
    : m_folder(fs::absolute(options.journal).string()),
      m_game(std::move(game)),
      m_seed(options.seed),
      m_frame_nanos(static_cast<std::uint64_t>(
          std::chrono::nanoseconds(TickLength::fromMicros(options.frame_micros).times(1)).count())),
      m_ring(options.players == "private" ? kPrivateRing : kSharedRing),
      m_facts(factsOfMachine()),
      m_log(std::move(log)) {
  m_facts[kFactGame] = m_game;
  m_facts[kFactVersion] = kVersion;
  m_facts[kFactPlayers] = options.players;
  m_facts[kFactGameOver] = options.on_game_over;
  m_facts[kFactClocks] = repeatPreload().empty() ? "real" : "repeatable";
  if (!module.empty()) m_facts[kFactModule] = hashOfModule(module);
  if (const std::string settings = readSettings(); !settings.empty()) m_facts[kFactSettings] = settings;
  for (const std::string& entry : makeFixedEnvironment(options)) {
    const std::size_t equals = entry.find('=');
    if (isGameVariable(entry)) m_facts[kFactVariable + entry.substr(0, equals)] = entry.substr(equals + 1);
  }
  for (const std::string& sentence : salvageRounds(m_folder)) m_log(sentence);
  m_log("each round is written down in " + m_folder);
  if (repeatPreload().empty())
    m_log("warning: libdragonfly-repeat.so is missing: a game that reads a clock cannot be executed again");
}

WorldOrder Journals::makeOrder() const {
  WorldOrder order;
  order.seed = m_seed != 0 ? static_cast<std::uint64_t>(m_seed) : newSeed();
  order.repeatable = true;
  order.start_nanos = static_cast<std::uint64_t>(
      std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count());
  order.frame_nanos = m_frame_nanos;
  return order;
}

std::string Journals::pathOf(const DfrHeader& header) const {
  const auto seconds = static_cast<std::time_t>(header.start_nanos / 1'000'000'000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char when[32];
  std::strftime(when, sizeof when, "%Y%m%d-%H%M%S", &utc);
  return m_folder + "/" + m_game + "-" + when + "-" + uuidText(header.uuid).substr(0, 8) + ".dfr";
}

std::unique_ptr<WorldPort> Journals::keep(std::unique_ptr<WorldProcess> world, const WorldOrder& order,
                                          RepeatCheck::NewWorld again) {
  DfrHeader header;
  std::random_device device;
  for (std::uint8_t& byte : header.uuid) byte = static_cast<std::uint8_t>(device());
  header.seed = order.seed;
  header.start_nanos = order.start_nanos;
  header.frame_nanos = order.frame_nanos;
  const std::string path = pathOf(header);
  JournaledWorld::Book book;
  book.writer = m_writer;
  try {
    book.journal =
        std::make_shared<Journal>(std::make_unique<JournalFileSink>(path), header, m_facts, m_ring, true);
  } catch (const std::system_error& error) {
    m_log({LogEvent::Level::kError, "this round is not written down: " + std::string(error.what())});
    return world;
  }
  book.late_facts = [p_world = world.get()] { return factsOfStart(*p_world); };
  book.on_problem = [log = m_log, path](const std::string& problem) {
    log({LogEvent::Level::kError,
         "the round is not written down any more, and goes on: " + problem + " (" + path + ")"});
  };
  if (again && !std::exchange(m_checked, true)) {
    book.check = std::make_unique<RepeatCheck>(std::move(again), [log = m_log](const std::string& sentence) {
      log({LogEvent::Level::kWarning, "warning: " + sentence});
    });
  }
  m_writer->add(book.journal);
  return std::make_unique<JournaledWorld>(std::move(world), std::move(book));
}

}  // namespace naiad
