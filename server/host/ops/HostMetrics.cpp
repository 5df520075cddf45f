#include "host/ops/HostMetrics.h"

#include <time.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include "host/loop/HostClients.h"
#include "host/loop/HostEndpoint.h"
#include "host/metrics/Exposition.h"
#include "host/metrics/MetricsPage.h"
#include "host/process/TickClock.h"
#include "host/settings/MetricsAddress.h"

namespace naiad {

namespace {

constexpr std::chrono::seconds kMeasureInterval{1};

std::chrono::nanoseconds cpuOf(clockid_t clock) {
  timespec spent{};
  clock_gettime(clock, &spent);
  return std::chrono::seconds(spent.tv_sec) + std::chrono::nanoseconds(spent.tv_nsec);
}

MetricsServer::Response answerOf(const HostHealth::Result& verdict) {
  return {verdict.is_good ? 200 : 503, verdict.sentence + "\n"};
}

}  // namespace

HostMetrics::HostMetrics(const HostAccess& access) : m_access(access), m_health(access.context.stages) {
  const HostOptions& options = access.context.options;
  access.context.stages.start();
  const MetricsAddress address = *MetricsAddress::parse(options.metrics);
  try {
    m_server = std::make_unique<MetricsServer>(address, *MetricsHosts::parse(options.metrics_hosts),
                                               [this](std::string_view path) { return answer(path); });
  } catch (const MetricsError& error) {  // reported like an error of the players' port
    throw ListenError(error.what(), std::make_error_code(std::errc::address_in_use));
  }
  access.context.log("metrics are at http://" + address.hostText() + ":" + std::to_string(m_server->port()) +
                     "/metrics");
}

HostMetrics::~HostMetrics() = default;

// Runs on the thread of the MetricsServer.
MetricsServer::Response HostMetrics::answer(std::string_view path) {
  if (path == "/metrics") {
    return {200, renderMetrics(m_newest.readLatest(), ProcessInfo::read()), kExpositionType};
  }
  if (path == "/healthz") return answerOf(m_health.health(Clock::now()));
  if (path == "/readyz") return answerOf(m_health.readiness(Clock::now()));
  return {404, "Not found; there are /metrics, /healthz and /readyz.\n"};
}

void HostMetrics::begin() {
  const HostOptions& options = m_access.context.options;
  const auto tick = TickLength::fromMicros(options.frame_micros).times(1);
  m_next.tick_length = std::chrono::duration<double>(tick).count();
  m_measure_at = Clock::now();
  m_health.begin(tick, m_measure_at);
  if (options.audit == "on")
    m_access.clients.rooms().startAudit(static_cast<std::uint32_t>(std::chrono::seconds(1) / tick));
}

void HostMetrics::tick(Clock::time_point now) {
  m_access.context.shutdown_scheduler.acceptsPlayers() ? m_health.cancelDrain() : m_health.beginDrain(true);
  if (now >= m_measure_at) measure(now);
}

void HostMetrics::measure(Clock::time_point now) {
  m_measure_at = now + kMeasureInterval;
  const HostContext& context = m_access.context;
  NetworkThread& network = m_access.endpoint.network();
  m_next.max_players = static_cast<std::uint64_t>(context.options.max_players);
  m_next.counters = context.counters;
  m_next.passwords = m_access.clients.admission().passwordCounters();
  m_next.network = network.latestCounters();
  network.requestCounters();  // for the next call
  m_next.stages = context.stages.spent();
  m_next.tick_lateness = context.stages.lateness();
  m_next.tick_durations = context.stages.durations();
  m_next.rooms = m_access.clients.rooms().countAwake();
  measureRooms();
  m_next.objects = m_access.clients.rooms().objects();
  measureSessions();
  measureCpu();
  m_health.setFull(m_next.connected + m_next.detached >= m_next.max_players);
  m_newest.publish(std::make_unique<const MetricsSnapshot>(m_next));
}

void HostMetrics::measureRooms() {
  m_next.named_rooms.clear();
  const RoomManager& rooms = m_access.clients.rooms();
  if (!rooms.isNamed()) return;
  rooms.forEachRoom([this](const Room& room) {
    m_next.named_rooms.push_back(
        {room.plan()->name, room.plan()->game, room.countPlaying(), room.lateTicks(), room.isAsleep()});
  });
}

void HostMetrics::measureSessions() {
  m_next.connected = m_next.detached = m_next.greeting = 0;
  m_access.clients.sessions().forEach([this](const Session& session) {
    if (session.state() != Session::State::kPlaying) {
      ++m_next.greeting;
      return;
    }
    ++(session.isDetached() ? m_next.detached : m_next.connected);
    const std::chrono::duration<double> round_trip = session.transport().roundTrip();
    if (round_trip.count() > 0) m_next.round_trips.add(round_trip.count());
    if (!session.isDetached()) m_next.losses.add(session.sender().loss());
  });
}

// The clocks are read one after the other, so `other` is not exact. But no counter ever decreases.
void HostMetrics::measureCpu() {
  MetricsSnapshot::Cpu& cpu = m_next.cpu;
  cpu.tick = cpuOf(CLOCK_THREAD_CPUTIME_ID);
  cpu.network = std::max(cpu.network, m_access.endpoint.network().cpuTime());
  cpu.metrics = m_server->cpuTime();
  cpu.other = std::max(cpu.other, cpuOf(CLOCK_PROCESS_CPUTIME_ID) - cpu.tick - cpu.network - cpu.metrics);
}

}  // namespace naiad
