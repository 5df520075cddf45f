// The quality of dfclient and its alternatives at terminals over a bad network.
#include <cmath>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "ResultLine.h"
#include "Suite.h"
#include "path/suite/Measurement.h"
#include "path/suite/Peers.h"

namespace bench {
namespace {

using path::Condition;
using path::Effort;
using path::Figures;

// ssh's known rate for this scene in the first condition, in kbit/s. Another rate means that the scene or the
// link differs from that of the reference measurement.
constexpr double kSshKbitS = 713;
constexpr double kSshTolerance = 0.25;
// Limit of the link's own lateness, in ms: in a valid run it delays packets by at most this beyond their
// time.
constexpr double kLateMs = 2;

const Condition kUsual{100, 2, 0};
const std::vector<Condition> kConditions = {kUsual, {200, 2, 0}, {100, 0, 512}};

/// Keys of the printed line, in order. If a program lacks a figure, its key is left out.
const std::vector<std::string> kKeys = {"kbit_s_down",      "kbit_s_up",        "fps",
                                        "staleness_p50_ms", "staleness_p99_ms", "freeze_ms",
                                        "key_p50_ms",       "key_p99_ms",       "predicted_key_p99_ms",
                                        "refused_frames",   "keys_lost",        "link_late_p99_ms"};

std::string congestionControl() {
  std::ifstream file("/proc/sys/net/ipv4/tcp_congestion_control");
  std::string name;
  file >> name;
  return name.empty() ? "unknown" : name;
}

class Run {
 public:
  explicit Run(const Options& options) {
    if (options.quick) m_effort = {2, 10, 1};
  }

  void measure(const std::string& program, const Condition& condition) {
    if (const auto reason = path::notPossibleBecause(program)) return skip(program, condition, *reason);
    progress("path: " + program + ", RTT " + std::to_string(std::lround(condition.rtt_ms)) + " ms");
    Figures figures;
    try {
      figures = path::measure(program, condition, m_effort);
    } catch (const std::exception& error) {
      progress(std::string("path: ") + error.what());
      Line line("path");
      addCondition(line, program, condition);
      line.addZero("failed", 1);
      return;
    }
    if (program == "ssh" && condition == kUsual) {
      m_as_known = std::abs(figures.at("kbit_s_down") / kSshKbitS - 1) <= kSshTolerance;
    }
    Line line("path");
    addCondition(line, program, condition);
    for (const std::string& key : kKeys) {
      if (figures.contains(key)) line.add(key, figures.at(key));
    }
    line.add("seeds", m_effort.seeds).add("tcp", congestionControl());
    if (path::isOurs(program) && !path::servesOthers()) line.add("encrypted", 0);
    const bool punctual = figures.at("link_late_p99_ms") <= kLateMs;
    if (m_as_known || !punctual) line.add("valid", punctual && m_as_known.value_or(false) ? 1 : 0);
  }

 private:
  static void addCondition(Line& line, const std::string& program, const Condition& condition) {
    line.add("program", program).add("rtt_ms", condition.rtt_ms);
    line.add("loss_percent", condition.loss_percent).add("rate_kbit_s", condition.rate_kbit_s);
  }

  static void skip(const std::string& program, const Condition& condition, const std::string& reason) {
    Line line("path");
    addCondition(line, program, condition);
    line.add("skipped", reason);
  }

  Effort m_effort;
  std::optional<bool> m_as_known;  // set after ssh was measured: true if its rate was the known one
};

void run(const Options& options) {
  if (const auto reason = path::notAllowedBecause()) {
    Line("path").add("skipped", *reason);
    return;
  }
  Run run(options);
  const std::vector<std::string> programs = namesFrom("NAIAD_PATH_PROGRAMS", path::peerNames());
  for (const Condition& condition : options.quick ? std::vector<Condition>{kUsual} : kConditions) {
    for (const std::string& program : programs) run.measure(program, condition);
  }
}

const Suite suite("path", "a game across a bad network: dfclient, ssh and mosh", run);

}  // namespace
}  // namespace bench
