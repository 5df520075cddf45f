#include "server/directory/Directory.h"

#include <unistd.h>

#include <algorithm>
#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>
#include <asio/steady_timer.hpp>
#include <condition_variable>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "host/auth/ServerIdentity.h"
#include "server/directory/FleetList.h"
#include "shared/net/base/SafeFile.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

// The file of a list of servers: replaced in one step, by a thread of its own, so that a disk that stalls
// delays no player.

class ListFile {
 public:
  /// Writes the first text. Throws std::runtime_error if that fails.
  ListFile(std::string path, std::string text);
  /// Removes the file: a list that is not kept up leads to servers that are gone.
  ~ListFile();
  ListFile(const ListFile&) = delete;
  ListFile& operator=(const ListFile&) = delete;

  /// Written soon, if it is another one. Does not wait. Any thread.
  void setText(std::string text);
  /// What is new about writing, as a line of the log; else empty. Any thread.
  std::string takeNews();

 private:
  void run();
  void noteResult(const std::string& problem);

  const std::string m_path;
  std::mutex m_mutex;
  std::condition_variable m_wake;
  std::string m_text;
  std::string m_news;
  bool m_has_text = false;  ///< that is not written yet
  bool m_failing = false;
  bool m_stopping = false;
  std::thread m_thread;  ///< last: it uses the others
};

constexpr std::chrono::seconds kAgain{2};  ///< after a failure

/// Empty if it was written.
std::string writeProblem(const std::string& path, const std::string& text) {
  try {
    publishFile(path, text);
  } catch (const std::system_error& error) {
    return error.what();
  }
  return "";
}

ListFile::ListFile(std::string path, std::string text) : m_path(std::move(path)), m_text(std::move(text)) {
  if (const std::string problem = writeProblem(m_path, m_text); !problem.empty())
    throw std::runtime_error("The list " + m_path + " cannot be written: " + problem);
  m_thread = std::thread([this] { run(); });
}

ListFile::~ListFile() {
  {
    const std::lock_guard lock(m_mutex);
    m_stopping = true;
  }
  m_wake.notify_one();
  m_thread.join();
  ::unlink(m_path.c_str());
}

void ListFile::setText(std::string text) {
  {
    const std::lock_guard lock(m_mutex);
    if (m_text == text) return;
    m_text = std::move(text);
    m_has_text = true;
  }
  m_wake.notify_one();
}

std::string ListFile::takeNews() {
  const std::lock_guard lock(m_mutex);
  return std::exchange(m_news, std::string());
}

void ListFile::run() {
  std::unique_lock lock(m_mutex);
  while (!m_stopping) {
    m_wake.wait(lock, [this] { return m_stopping || m_has_text; });
    if (m_stopping) return;
    m_has_text = false;
    const std::string text = m_text;
    lock.unlock();
    const std::string problem = writeProblem(m_path, text);
    lock.lock();
    noteResult(problem);
    if (problem.empty()) continue;
    m_has_text = true;
    m_wake.wait_for(lock, kAgain, [this] { return m_stopping; });
  }
}

// A full disk is said once, and once more when it is over.
void ListFile::noteResult(const std::string& problem) {
  const bool failing = !problem.empty();
  if (std::exchange(m_failing, failing) == failing) return;
  m_news = failing ? "warning: the list " + m_path + " cannot be written: " + problem
                   : "the list " + m_path + " is written again";
}

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kMaxTurn{250};

/// Servers that come and go are seen soon, in each of their intervals a few times.
std::chrono::milliseconds turnOf(const DirectorySettings& settings) {
  return std::min(kMaxTurn, settings.interval / 4);
}

BusSettings listening(BusSettings settings) {
  settings.subjects = {presenceSubject("*")};
  return settings;
}

ServerIdentity identityOf(const DirectorySettings& settings) {
  if (!settings.certificate.empty()) return ServerIdentity::load(settings.certificate, settings.key);
  const std::filesystem::path folder = settings.identity.empty() ? ServerIdentity::defaultDirectory()
                                                                 : std::filesystem::path(settings.identity);
  return ServerIdentity::loadOrMake(folder, std::chrono::system_clock::now());
}

}  // namespace

struct Directory::Loop {
  Loop(DirectorySettings given, LogLine line);

  void openLobby();
  void reload();
  void takeTurn(Clock::time_point now);
  void sendOn(Clock::time_point now);
  void awaitTurn();
  void heedSignals();
  void stop();
  void logCounters();

  DirectorySettings settings;
  LogLine log;
  asio::io_context context{1};
  asio::steady_timer timer{context};
  asio::signal_set signals{context};
  std::optional<ListFile> file;
  FleetWatch fleet;
  std::optional<ServerIdentity> identity;
  std::optional<Lobby> lobby;
  Clock::time_point said_room{};
};

Directory::Loop::Loop(DirectorySettings given, LogLine line)
    : settings(std::move(given)),
      log(std::move(line)),
      fleet(
          connectBus(listening(settings.bus)), [this](const std::string& text) { log(text); }, Clock::now(),
          settings.interval) {
  if (!settings.list.empty()) file.emplace(settings.list, serverListText({}));
  openLobby();
  awaitTurn();
}

void Directory::Loop::openLobby() {
  if (!settings.lobby) return;
  identity = identityOf(settings);
  lobby.emplace(context, *settings.lobby, identity->tls(), fleet.servers());
}

// With a key that cannot be read the old one stays.
void Directory::Loop::reload() {
  LineLog::reopenAll();
  if (!lobby) return;
  try {
    ServerIdentity read = identityOf(settings);
    if (read.fingerprint() != identity->fingerprint())
      log("the lobby has another key now: links to it lead nowhere");
    identity = std::move(read);
    lobby->setTls(identity->tls());
  } catch (const TlsError& error) {
    log({LogEvent::Level::kWarning,
         std::string("warning: the lobby keeps its certificate: ") + error.what()});
  }
}

void Directory::Loop::awaitTurn() {
  timer.expires_after(turnOf(settings));
  timer.async_wait([this](const std::error_code& error) {
    if (error) return;
    takeTurn(Clock::now());
    awaitTurn();
  });
}

void Directory::Loop::takeTurn(Clock::time_point now) {
  fleet.update(now);
  sendOn(now);
  if (!file) return;
  file->setText(serverListText(fleet.servers().servers()));
  if (const std::string line = file->takeNews(); !line.empty()) log(line);
}

/// Servers that fill up are said where there is room.
void Directory::Loop::sendOn(Clock::time_point now) {
  if (now - said_room < settings.interval) return;
  said_room = now;
  for (const Presence& full : fleet.servers().crowded()) {
    const FleetList::Place other = fleet.servers().roomiest({full.game, full.protocol, full.id});
    if (!other) continue;
    const auto link = JoinLink::parse(linkOf(*other.p_server, other.room));
    if (const auto* const p_link = std::get_if<JoinLink>(&link))
      fleet.bus().publish({sendOnSubject(full.id), SendOn{other.p_server->id, *p_link}.payload()});
  }
}

void Directory::Loop::heedSignals() {
  signals.add(SIGINT);
  signals.add(SIGTERM);
  signals.add(SIGHUP);
  signals.async_wait([this](const std::error_code& error, int signal) {
    if (error) return;
    if (signal != SIGHUP) return stop();
    reload();
    heedSignals();
  });
}

void Directory::Loop::stop() {
  signals.clear();
  timer.cancel();
  context.stop();
}

void Directory::Loop::logCounters() {
  const FleetCounters& counted = fleet.servers().counters();
  const BusCounters passed = fleet.bus().counters();
  std::vector<std::pair<const char*, std::uint64_t>> all = {{"heard", counted.heard},
                                                            {"unreadable", counted.unreadable},
                                                            {"foreign", counted.foreign},
                                                            {"crowded", counted.crowded},
                                                            {"expired", counted.expired},
                                                            {"bus_received", passed.received},
                                                            {"bus_ignored", passed.ignored},
                                                            {"bus_failures", passed.failures},
                                                            {"bus_connections", passed.connections}};
  if (lobby) {
    const LobbyCounters& met = lobby->counters();
    const TcpListener::Counters& streams = lobby->streams();
    all.insert(all.end(), {{"hellos", met.hellos},
                           {"sent_on", met.sent_on},
                           {"no_place", met.no_place},
                           {"no_game", met.no_game},
                           {"malformed", met.malformed},
                           {"late", met.late},
                           {"guests_crowded", met.crowded},
                           {"handshakes", streams.handshakes},
                           {"handshakes_failed", streams.handshakes_failed},
                           {"handshakes_late", streams.handshakes_late},
                           {"refused_too_often", streams.refused_too_often}});
  }
  std::string line = "counters:";
  for (const auto& [name, count] : all) {
    if (count > 0) line += std::string(" ") + name + "=" + std::to_string(count);
  }
  log(line);
}

Directory::Directory(DirectorySettings settings, LogLine log)
    : m_loop(std::make_unique<Loop>(std::move(settings), std::move(log))) {}

Directory::~Directory() = default;

void Directory::heedSignals() {
  m_loop->heedSignals();
}

void Directory::run() {
  m_loop->context.run();
  m_loop->logCounters();
}

void Directory::stop() {
  m_loop->stop();
}

std::optional<std::uint16_t> Directory::port() const {
  return m_loop->lobby ? std::optional(m_loop->lobby->port()) : std::nullopt;
}

std::optional<Fingerprint> Directory::fingerprint() const {
  return m_loop->identity ? std::optional(m_loop->identity->fingerprint()) : std::nullopt;
}

}  // namespace naiad
