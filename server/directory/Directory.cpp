#include "server/directory/Directory.h"

#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>
#include <asio/steady_timer.hpp>
#include <csignal>
#include <optional>
#include <utility>

#include "server/directory/ListFile.h"
#include "server/directory/ServerList.h"
#include "shared/fleet/ServerId.h"
#include "shared/net/base/TokenBucket.h"

namespace naiad {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTurn{250};
/// Of servers that come and go, a second: names may come from servers that only pretend.
constexpr BucketRate kNewsRate{5, 100};

BusSettings listening(BusSettings settings) {
  settings.subjects = {presenceSubject("*")};
  return settings;
}

}  // namespace

struct Directory::Loop {
  Loop(DirectorySettings given, LogLine line);

  void takeTurn(Clock::time_point now);
  void listen(Clock::time_point now);
  void forget(Clock::time_point now);
  void publishList();
  void logNews(const std::string& line, Clock::time_point now);
  void awaitTurn();
  void heedSignals();
  void stop();
  void logCounters() const;

  DirectorySettings settings;
  LogLine log;
  asio::io_context context{1};
  asio::steady_timer timer{context};
  asio::signal_set signals{context};
  FleetList servers;
  std::unique_ptr<Bus> bus;
  std::optional<ListFile> file;
  Clock::time_point connected_at = Clock::now();
  TokenBucket news;
  std::uint64_t news_left_out = 0;
};

Directory::Loop::Loop(DirectorySettings given, LogLine line)
    : settings(std::move(given)), log(std::move(line)) {
  if (!settings.list.empty()) file.emplace(settings.list, serverListText({}));
  bus = connectBus(listening(settings.bus));
  awaitTurn();
}

void Directory::Loop::awaitTurn() {
  timer.expires_after(kTurn);
  timer.async_wait([this](const std::error_code& error) {
    if (error) return;
    takeTurn(Clock::now());
    awaitTurn();
  });
}

void Directory::Loop::takeTurn(Clock::time_point now) {
  if (const std::string line = bus->takeNews(); !line.empty()) log(line);
  listen(now);
  forget(now);
  publishList();
}

void Directory::Loop::listen(Clock::time_point now) {
  for (const BusMessage& message : bus->takeMessages()) {
    if (servers.put(message.subject, message.payload, now))
      logNews(message.subject.substr(presenceSubject("").size()) + " is there", now);
  }
}

// Servers cannot be heard without a bus, so their time does not run; it does once that has lasted for too
// long.
void Directory::Loop::forget(Clock::time_point now) {
  if (bus->isConnected()) connected_at = now;
  const bool is_blind = connected_at != now;
  if (is_blind && now - connected_at < kBlind) return servers.forgiveSilence(now);
  for (const std::string& id : servers.removeSilent(now)) logNews(id + " is gone", now);
}

void Directory::Loop::publishList() {
  if (!file) return;
  file->setText(serverListText(servers.servers()));
  if (const std::string line = file->takeNews(); !line.empty()) log(line);
}

void Directory::Loop::logNews(const std::string& line, Clock::time_point now) {
  if (!news.takeToken(kNewsRate, now)) {
    ++news_left_out;
    return;
  }
  if (const auto count = std::exchange(news_left_out, 0); count > 0)
    log(std::to_string(count) + " more servers came or went");
  log(line);
}

void Directory::Loop::heedSignals() {
  signals.add(SIGINT);
  signals.add(SIGTERM);
  signals.add(SIGHUP);
  signals.async_wait([this](const std::error_code& error, int signal) {
    if (error) return;
    if (signal != SIGHUP) return stop();
    LineLog::reopenAll();
    heedSignals();
  });
}

void Directory::Loop::stop() {
  signals.clear();
  timer.cancel();
  context.stop();
}

void Directory::Loop::logCounters() const {
  const FleetCounters& counted = servers.counters();
  const BusCounters passed = bus->counters();
  const std::pair<const char*, std::uint64_t> all[] = {{"heard", counted.heard},
                                                       {"unreadable", counted.unreadable},
                                                       {"foreign", counted.foreign},
                                                       {"crowded", counted.crowded},
                                                       {"expired", counted.expired},
                                                       {"bus_received", passed.received},
                                                       {"bus_ignored", passed.ignored},
                                                       {"bus_failures", passed.failures},
                                                       {"bus_connections", passed.connections}};
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

const FleetList& Directory::servers() const {
  return m_loop->servers;
}

}  // namespace naiad
