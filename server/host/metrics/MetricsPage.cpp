#include "host/metrics/MetricsPage.h"

#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "host/metrics/Exposition.h"
#include "host/metrics/HostHealth.h"
#include "host/session/CounterTable.h"
#include "shared/net/base/Limits.h"
#include "shared/values/Version.h"

namespace naiad {

namespace {

/// Position of the start time among the fields after the name in /proc/self/stat (proc(5), field 22). Its
/// unit is clock ticks since the machine's boot.
constexpr int kStartTime = 20;

std::string textOf(const char* path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

double startTime() {
  const std::string text = textOf("/proc/self/stat");
  // Starts after the last bracket, because the program's name before it may contain spaces and brackets.
  std::istringstream fields(text.substr(std::min(text.rfind(')') + 1, text.size())));
  std::string field;
  for (int i = 0; i < kStartTime && fields >> field; ++i) {
  }
  const std::string all = textOf("/proc/stat");
  const std::size_t boot = all.find("\nbtime ");
  if (!fields || boot == std::string::npos) return 0;
  return std::strtod(all.c_str() + boot + 7, nullptr) +
         std::strtod(field.c_str(), nullptr) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

std::uint64_t openFiles() {
  std::error_code error;
  std::uint64_t count = 0;
  for (std::filesystem::directory_iterator at("/proc/self/fd", error), end; !error && at != end;
       at.increment(error)) {
    ++count;
  }
  return count == 0 ? 0 : count - 1;  // without the descriptor of the folder itself
}

double seconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

void writeBuild(Exposition& out) {
  out.begin("naiad_build_info", MetricType::kGauge,
            "Versions of the server and the protocol, as labels; always 1.");
  out.add(metricLabel("version", kVersion) + "," +
              metricLabel("protocol", std::to_string(static_cast<unsigned>(kProtocolVersion))),
          std::uint64_t{1});
}

void writeTicks(Exposition& out, const MetricsSnapshot& snapshot) {
  out.begin("naiad_tick_length_seconds", MetricType::kGauge, "Configured length of a tick.");
  out.add("", snapshot.tick_length);
  out.begin("naiad_tick_duration_seconds", MetricType::kHistogram,
            "Time from the start of a tick until its last packet is sent, including game processes.");
  out.add(snapshot.tick_durations);
  out.begin("naiad_tick_lateness_seconds", MetricType::kHistogram,
            "Delay of a tick's start after its deadline.");
  out.add(snapshot.tick_lateness);
  out.begin("naiad_stage_seconds_total", MetricType::kCounter,
            "Time of the tick thread, by stage; idle: serving streams or waiting.");
  for (std::size_t i = 0; i < kStages; ++i) {
    out.add(metricLabel("stage", nameOf(static_cast<Stage>(i))), seconds(snapshot.stages[i]));
  }
}

void writePlayers(Exposition& out, const MetricsSnapshot& snapshot) {
  out.begin("naiad_players", MetricType::kGauge, "Players, by state of their connection.");
  out.add(R"(state="connected")", snapshot.connected);
  out.add(R"(state="detached")", snapshot.detached);
  out.begin("naiad_max_players", MetricType::kGauge, "Maximum number of players.");
  out.add("", snapshot.max_players);
  out.begin("naiad_pending_connections", MetricType::kGauge,
            "Connections that have not joined yet or are closing.");
  out.add("", snapshot.greeting);
  out.begin("naiad_rooms", MetricType::kGauge, "Worlds that are running.");
  out.add("", snapshot.rooms);
  out.begin("naiad_objects", MetricType::kGauge, "Objects that players are sent, in worlds with players.");
  out.add("", snapshot.objects);
  out.begin("naiad_round_trip_seconds", MetricType::kHistogram,
            "Round-trip time from a snapshot to its acknowledgement: one sample per player and second.");
  out.add(snapshot.round_trips);
  out.begin("naiad_loss_ratio", MetricType::kHistogram,
            "Share of recent snapshots that were lost: one sample per player and second.");
  out.add(snapshot.losses);
}

void writeNamedRooms(Exposition& out, const std::vector<MetricsSnapshot::NamedRoom>& rooms) {
  if (rooms.empty()) return;
  const auto labels = [](const MetricsSnapshot::NamedRoom& room) {
    return metricLabel("room", room.name) + "," + metricLabel("game", room.game);
  };
  out.begin("naiad_room_players", MetricType::kGauge, "Players, by room.");
  for (const auto& room : rooms) out.add(labels(room), room.players);
  out.begin("naiad_room_asleep", MetricType::kGauge,
            "1 if the room has no world; a world starts when a player joins.");
  for (const auto& room : rooms) out.add(labels(room), std::uint64_t{room.asleep ? 1u : 0u});
  out.begin("naiad_room_late_ticks_total", MetricType::kCounter,
            "Ticks that a room's world missed because its previous tick was still running.");
  for (const auto& room : rooms) out.add(labels(room), room.late_ticks);
}

void writeCpu(Exposition& out, const MetricsSnapshot::Cpu& cpu) {
  out.begin("naiad_thread_cpu_seconds_total", MetricType::kCounter, "CPU time, by thread.");
  out.add(R"(thread="tick")", seconds(cpu.tick));
  out.add(R"(thread="network")", seconds(cpu.network));
  out.add(R"(thread="metrics")", seconds(cpu.metrics));
  out.add(R"(thread="other")", seconds(cpu.other));
}

template <class Struct>
void writeCounters(Exposition& out, const Struct& counters) {
  for (const CounterSample& sample : samplesOf(counters)) {
    if (!sample.help.empty()) out.begin(sample.family, MetricType::kCounter, sample.help);
    out.add(sample.labels, sample.metric_value);
  }
}

}  // namespace

ProcessInfo ProcessInfo::read() {
  static const double start_seconds = startTime();
  ProcessInfo facts;
  facts.start_seconds = start_seconds;
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  facts.cpu_seconds = static_cast<double>(cpu.tv_sec) + static_cast<double>(cpu.tv_nsec) * 1e-9;
  std::istringstream pages(textOf("/proc/self/statm"));
  pages >> facts.virtual_size >> facts.resident;
  const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  facts.virtual_size *= page;
  facts.resident *= page;
  facts.open_files = openFiles();
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) == 0) facts.max_files = files.rlim_cur;
  return facts;
}

void writeProcess(Exposition& out, const ProcessInfo& facts) {
  out.begin("process_cpu_seconds_total", MetricType::kCounter, "CPU time of the process.");
  out.add("", facts.cpu_seconds);
  out.begin("process_resident_memory_bytes", MetricType::kGauge, "Resident memory of the process.");
  out.add("", facts.resident);
  out.begin("process_virtual_memory_bytes", MetricType::kGauge, "Virtual memory of the process.");
  out.add("", facts.virtual_size);
  out.begin("process_open_fds", MetricType::kGauge, "Number of open files and sockets.");
  out.add("", facts.open_files);
  out.begin("process_max_fds", MetricType::kGauge, "Maximum number of open files and sockets.");
  out.add("", facts.max_files);
  out.begin("process_start_time_seconds", MetricType::kGauge,
            "Start time of the process, in seconds since 1970.");
  out.add("", facts.start_seconds);
}

std::string renderMetrics(const MetricsSnapshot* p_snapshot, const ProcessInfo& process) {
  Exposition out;
  writeBuild(out);
  if (p_snapshot != nullptr) {
    writeTicks(out, *p_snapshot);
    writePlayers(out, *p_snapshot);
    writeNamedRooms(out, p_snapshot->named_rooms);
    writeCounters(out, p_snapshot->counters);
    writeCounters(out, p_snapshot->passwords);
    writeCounters(out, p_snapshot->network.streams);
    writeCounters(out, p_snapshot->network.visitors);
    writeCounters(out, p_snapshot->network.relay);
    writeCounters(out, p_snapshot->network.gate);
    writeCounters(out, p_snapshot->network.udp);
    writeCounters(out, p_snapshot->network.traffic);
    writeCpu(out, p_snapshot->cpu);
  }
  writeProcess(out, process);
  return out.text();
}

}  // namespace naiad
