#include "host/metrics/ProcessFacts.h"

#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "host/metrics/Exposition.h"

namespace naiad {

namespace {

/// Of proc(5), the fields of /proc/self/stat after the name.
constexpr int kStartTime = 20;  ///< field 22: in clock ticks after the start of the machine

std::string textOf(const char* path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

double startTime() {
  const std::string text = textOf("/proc/self/stat");
  // A program's name may have spaces and brackets in it.
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
  return count == 0 ? 0 : count - 1;  // without that of the folder itself
}

}  // namespace

ProcessFacts ProcessFacts::read() {
  static const double start_seconds = startTime();
  ProcessFacts facts;
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

void writeProcess(Exposition& out, const ProcessFacts& facts) {
  out.begin("process_cpu_seconds_total", MetricType::kCounter, "CPU time of the process.");
  out.add("", facts.cpu_seconds);
  out.begin("process_resident_memory_bytes", MetricType::kGauge, "Memory of the process that is in RAM.");
  out.add("", facts.resident);
  out.begin("process_virtual_memory_bytes", MetricType::kGauge, "Addresses of the process.");
  out.add("", facts.virtual_size);
  out.begin("process_open_fds", MetricType::kGauge, "Files and sockets that are open.");
  out.add("", facts.open_files);
  out.begin("process_max_fds", MetricType::kGauge, "Files and sockets that may be open.");
  out.add("", facts.max_files);
  out.begin("process_start_time_seconds", MetricType::kGauge,
            "When the process began, in seconds since 1970.");
  out.add("", facts.start_seconds);
}

}  // namespace naiad
