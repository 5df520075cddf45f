#include "TestServer.h"

#include "engine/world/Capture.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "engine/world/WorldLog.h"

namespace naiad::test {

HostOptions fastOptions() {
  HostOptions options;
  options.port = 0;
  options.address = "127.0.0.1";
  options.insecure = true;
  options.grace = 0;
  options.frame_micros = 3000;
  return options;
}

TestServer::TestServer(std::function<void(df::World&)> populate, HostOptions options)
    : m_host(std::make_unique<Host>(std::move(options), "test",
                                    [this](const LogEvent& event) { readLog(event); })) {
  m_host->setObserver([this](df::World& world) { record(world); });
  std::promise<void> populated;
  m_thread = std::thread([this, populate = std::move(populate), &populated] {
    df::World world;
    world.log().setSink([](const std::string&) {});
    const df::World::Scope scope(world);
    populate(world);
    populated.set_value();
    m_host->run(world);
    m_host->finish();
    world.shutDown();
  });
  populated.get_future().wait();
}

TestServer::~TestServer() {
  stop("The test is over.");
}

void TestServer::stop(const std::string& sentence) {
  if (!m_thread.joinable()) return;
  m_host->stop(sentence);
  m_thread.join();
}

void TestServer::readLog(const LogEvent& event) {
  const std::string begin = "metrics are at http://127.0.0.1:";
  if (event.text.starts_with(begin))
    m_metrics_port = static_cast<std::uint16_t>(std::stoi(event.text.substr(begin.size())));
}

void TestServer::record(df::World& world) {
  if (!m_draws) return;
  const std::lock_guard lock(m_mutex);
  for (const df::Player* player : world.views().getPlayers()) {
    m_truth[{static_cast<std::uint32_t>(world.getStepCount()), player->getId()}] =
        world.picture().renderPlayer(player->getId());
  }
}

std::optional<df::Canvas> TestServer::truth(std::uint32_t tick, std::uint32_t player) const {
  const std::lock_guard lock(m_mutex);
  const auto found = m_truth.find({tick, player});
  if (found == m_truth.end()) return std::nullopt;
  return found->second;
}

}  // namespace naiad::test
