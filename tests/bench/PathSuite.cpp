// The quality of dfclient and its alternatives at terminals over a bad network.
#include <cmath>
#include <exception>
#include <fstream>
#include <future>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "Percentile.h"
#include "ResultLine.h"
#include "Suite.h"
#include "Worker.h"
#include "path/Peers.h"
#include "tests/support/TempFolder.h"

namespace bench {
namespace {

using path::append;
using path::Peer;
using path::Place;
using path::Words;

/// Conditions of the link.
struct Condition {
  double rtt_ms = 0;
  double loss_percent = 0;
  double rate_kbit_s = 0;  ///< 0: no limit
  bool operator==(const Condition&) const = default;
};

struct Effort {
  double warm_up_s = 5;
  double measure_s = 60;
  int seeds = 5;
};

/// The median over all seeds, for each figure that the judge reports, by its key.
using Figures = std::map<std::string, double>;

const std::string kBin = NAIAD_BINARY_DIR "/bin";
constexpr const char* kSeparator = ":::";
constexpr int kNotAllowed = 77;
constexpr const char* kAddress = "10.77.0.1";
constexpr const char* kLoopbackAddress = "127.77.0.1";  // an address that the link can carry, too

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

/// Returns the client's address: 10.77.0.2 for 10.77.0.1.
std::string clientOf(const std::string& server_address) {
  return server_address.substr(0, server_address.rfind('.')) + ".2";
}

Words linkCommand(const Place& place, const Peer& peer, const Condition& condition) {
  Words words = {kBin + "/naiad_link", "--counters", place.file("counters"), "--server-log",
                 place.file("log")};
  append(words, {"--server-address", place.address, "--client-address", clientOf(place.address)});
  append(words, {"--ready-file", peer.ready_file, "--seed", std::to_string(place.seed)});
  append(words, {"--delay-ms", std::to_string(condition.rtt_ms / 2)});
  append(words, {"--loss-percent", std::to_string(condition.loss_percent)});
  append(words, {"--rate-kbit", std::to_string(condition.rate_kbit_s)});
  if (!peer.udp) words.emplace_back("--block-udp");
  words.emplace_back(kSeparator);
  append(words, peer.server);
  words.emplace_back(kSeparator);
  return words;
}

Words judgeCommand(const Place& place, const Peer& peer, const Effort& effort) {
  Words words = {kBin + "/naiad_pty_judge", "--truth", place.truth(), "--counters", place.file("counters")};
  append(words, {"--warm-up", std::to_string(effort.warm_up_s)});
  append(words, {"--measure", std::to_string(effort.measure_s), "--seed", std::to_string(place.seed)});
  if (!peer.type_ahead.empty()) append(words, {"--type-ahead", peer.type_ahead});
  if (!peer.first_keys.empty()) append(words, {"--first-keys", peer.first_keys});
  if (peer.arrows) words.emplace_back("--arrows");
  words.emplace_back("--");
  append(words, peer.client);
  return words;
}

/// True if dfserver listens on addresses other than loopback addresses. Otherwise the link joins two loopback
/// addresses, and its traffic is not encrypted.
bool servesOthers() {
  static const bool s_serves = [] {
    const naiad::test::TempFolder folder;
    const Place place{kBin, folder.string(), kAddress, 1};
    Words command = linkCommand(place, path::preparePeer("dfclient", place), {});
    command.emplace_back("true");
    return runProgram(command).code == 0;
  }();
  return s_serves;
}

Figures runOnce(const std::string& program, const Condition& condition, const Effort& effort,
                std::uint64_t seed) {
  const naiad::test::TempFolder folder;
  const std::string address = path::isOurs(program) && !servesOthers() ? kLoopbackAddress : kAddress;
  const Place place{kBin, folder.string(), address, seed};
  const Peer peer = path::preparePeer(program, place);
  Words command = linkCommand(place, peer, condition);
  append(command, judgeCommand(place, peer, effort));
  const Worker::End finished = runProgram(command);
  if (finished.code != 0) throw std::runtime_error(program + " could not be measured");
  return figuresOf(finished.output);
}

/// Measures all seeds at once. Throws std::runtime_error if a run failed.
Figures medians(const std::string& program, const Condition& condition, const Effort& effort) {
  std::vector<std::future<Figures>> runs;
  for (int seed = 1; seed <= effort.seeds; ++seed) {
    runs.push_back(std::async(std::launch::async, runOnce, program, condition, effort,
                              static_cast<std::uint64_t>(seed)));
  }
  std::map<std::string, std::vector<double>> samples;
  for (auto& run : runs) {
    for (const auto& [key, value] : run.get()) samples[key].push_back(value);
  }
  Figures result;
  for (const auto& [key, values] : samples) result[key] = quantile(values, 0.5);
  return result;
}

/// Returns why this machine does not allow measurements; nullopt if it does.
std::optional<std::string> notAllowedBecause() {
  const Worker::End finished = runProgram({kBin + "/naiad_link", "--check"});
  if (finished.code == 0) return std::nullopt;
  if (finished.code != kNotAllowed) return "naiad_link-failed";
  return finished.output.substr(0, finished.output.find('\n'));
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
      figures = medians(program, condition, m_effort);
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
    if (path::isOurs(program) && !servesOthers()) line.add("encrypted", 0);
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
  if (const auto reason = notAllowedBecause()) {
    Line("path").add("skipped", *reason);
    return;
  }
  Run run(options);
  const std::vector<std::string> programs = namesFrom("NAIAD_PATH_PROGRAMS", path::kPeerNames);
  for (const Condition& condition : options.quick ? std::vector<Condition>{kUsual} : kConditions) {
    for (const std::string& program : programs) run.measure(program, condition);
  }
}

const Suite suite("path", "a game across a bad network: dfclient, ssh and mosh", run);

}  // namespace
}  // namespace bench
