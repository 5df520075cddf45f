#include "host/ops/HostMetrics.h"

#include <time.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include "host/metrics/Exposition.h"
#include "host/metrics/MetricsAddress.h"
#include "host/metrics/MetricsPage.h"
#include "host/metrics/ProcessFacts.h"

namespace naiad {

namespace {

constexpr std::chrono::seconds kMeasureEvery{1};

std::chrono::nanoseconds cpuOf(clockid_t clock) {
  timespec spent{};
  clock_gettime(clock, &spent);
  return std::chrono::seconds(spent.tv_sec) + std::chrono::nanoseconds(spent.tv_nsec);
}

MetricsServer::Answer answerOf(const HostPulse::Verdict& verdict) {
  return {verdict.is_good ? 200 : 503, verdict.sentence + "\n"};
}

}  // namespace

HostMetrics::HostMetrics(const Sources& sources) : m_sources(sources), m_pulse(sources.stages) {
  m_sources.stages.start();
  m_server = std::make_unique<MetricsServer>(*MetricsAddress::parse(sources.options.metrics),
                                             *MetricsHosts::parse(sources.options.metrics_hosts),
                                             [this](std::string_view path) { return answer(path); });
}

HostMetrics::~HostMetrics() = default;

// On the server's thread.
MetricsServer::Answer HostMetrics::answer(std::string_view path) {
  if (path == "/metrics") {
    return {200, renderMetrics(m_newest.takeLatest(), ProcessFacts::read()), kExpositionType};
  }
  if (path == "/healthz") return answerOf(m_pulse.health(Clock::now()));
  if (path == "/readyz") return answerOf(m_pulse.readiness(Clock::now()));
  return {404, "There are /metrics, /healthz and /readyz.\n"};
}

void HostMetrics::begin(std::chrono::nanoseconds tick_length) {
  m_next.tick_length = std::chrono::duration<double>(tick_length).count();
  m_measure_at = Clock::now();
  m_pulse.begin(tick_length, m_measure_at);
}

void HostMetrics::beginTick(std::uint64_t number, Clock::time_point deadline, Clock::time_point now) {
  m_pulse.beat(number, now);
  m_next.tick_lateness.add(std::chrono::duration<double>(now - deadline).count());
  m_tick_began = now;
  m_in_tick = true;
}

void HostMetrics::endTick(Clock::time_point now) {
  if (!std::exchange(m_in_tick, false)) return;
  m_next.tick_durations.add(std::chrono::duration<double>(now - m_tick_began).count());
}

void HostMetrics::update(Clock::time_point now) {
  if (now >= m_measure_at) measure(now);
}

void HostMetrics::measure(Clock::time_point now) {
  m_measure_at = now + kMeasureEvery;
  m_next.max_players = static_cast<std::uint64_t>(m_sources.options.max_players);
  m_next.counters = m_sources.counters;
  m_next.passwords = m_sources.admission.passwordCounters();
  m_next.network = m_sources.network.latestCounters();
  m_sources.network.askForCounters();  // for the next time
  m_next.stages = m_sources.stages.spent();
  m_next.rooms = m_sources.rooms.countAwake();
  measureRooms();
  m_next.objects = m_sources.rooms.objects();
  measureSessions();
  measureCpu();
  m_pulse.setFull(m_next.connected + m_next.detached >= m_next.max_players);
  m_newest.publish(std::make_unique<const MetricsSnapshot>(m_next));
}

void HostMetrics::measureRooms() {
  m_next.named_rooms.clear();
  if (!m_sources.rooms.isNamed()) return;
  m_sources.rooms.forEachRoom([this](const Room& room) {
    m_next.named_rooms.push_back(
        {room.plan()->name, room.plan()->game, room.countPlaying(), room.lateTicks(), room.isAsleep()});
  });
}

void HostMetrics::measureSessions() {
  m_next.connected = m_next.detached = m_next.greeting = 0;
  m_sources.sessions.forEach([this](const Session& session) {
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

// The clocks are read one after the other, so the rest is not exact; a counter must not fall all the same.
void HostMetrics::measureCpu() {
  MetricsSnapshot::Cpu& cpu = m_next.cpu;
  cpu.tick = cpuOf(CLOCK_THREAD_CPUTIME_ID);
  cpu.network = std::max(cpu.network, m_sources.network.cpuTime());
  cpu.metrics = m_server->cpuTime();
  cpu.other = std::max(cpu.other, cpuOf(CLOCK_PROCESS_CPUTIME_ID) - cpu.tick - cpu.network - cpu.metrics);
}

}  // namespace naiad
