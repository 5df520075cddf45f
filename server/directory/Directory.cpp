#include "server/directory/Directory.h"

#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <optional>
#include <utility>

#include "server/directory/FleetWatch.h"
#include "server/directory/ListFile.h"
#include "server/directory/ServerList.h"
#include "shared/fleet/ServerId.h"

namespace naiad {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTurn{250};

BusSettings listening(BusSettings settings) {
  settings.subjects = {presenceSubject("*")};
  return settings;
}

}  // namespace

struct Directory::Loop {
  Loop(DirectorySettings given, LogLine line);

  void takeTurn();
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
};

Directory::Loop::Loop(DirectorySettings given, LogLine line)
    : settings(std::move(given)),
      log(std::move(line)),
      fleet(
          connectBus(listening(settings.bus)), [this](const std::string& text) { log(text); }, Clock::now()) {
  if (!settings.list.empty()) file.emplace(settings.list, serverListText({}));
  awaitTurn();
}

void Directory::Loop::awaitTurn() {
  timer.expires_after(kTurn);
  timer.async_wait([this](const std::error_code& error) {
    if (error) return;
    takeTurn();
    awaitTurn();
  });
}

void Directory::Loop::takeTurn() {
  fleet.update(Clock::now());
  if (!file) return;
  file->setText(serverListText(fleet.servers().servers()));
  if (const std::string line = file->takeNews(); !line.empty()) log(line);
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

void Directory::Loop::logCounters() {
  const FleetCounters& counted = fleet.servers().counters();
  const BusCounters passed = fleet.bus().counters();
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

}  // namespace naiad
