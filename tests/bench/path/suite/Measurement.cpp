#include "Measurement.h"

#include <future>
#include <stdexcept>

#include "../judge/Quantile.h"
#include "Peers.h"
#include "Worker.h"
#include "tests/support/TempFolder.h"

namespace bench::path {
namespace {

using Words = std::vector<std::string>;

const std::string kBin = NAIAD_BINARY_DIR "/bin";
constexpr const char* kSeparator = ":::";
constexpr int kNotAllowed = 77;
constexpr const char* kAddress = "10.77.0.1";
constexpr const char* kLoopbackAddress = "127.77.0.1";  // an address that the link can carry, too

void append(Words& words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
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

Figures runOnce(const std::string& program, const Condition& condition, const Effort& effort,
                std::uint64_t seed) {
  const naiad::test::TempFolder folder;
  const std::string address = isOurs(program) && !servesOthers() ? kLoopbackAddress : kAddress;
  const Place place{kBin, folder.string(), address, seed};
  const Peer peer = preparePeer(program, place);
  Words command = linkCommand(place, peer, condition);
  append(command, judgeCommand(place, peer, effort));
  const Worker::End finished = runProgram(command);
  if (finished.code != 0) throw std::runtime_error(program + " could not be measured");
  return figuresOf(finished.output);
}

}  // namespace

std::optional<std::string> notAllowedBecause() {
  const Worker::End finished = runProgram({kBin + "/naiad_link", "--check"});
  if (finished.code == 0) return std::nullopt;
  if (finished.code != kNotAllowed) return "naiad_link-failed";
  return finished.output.substr(0, finished.output.find('\n'));
}

bool servesOthers() {
  static const bool s_serves = [] {
    const naiad::test::TempFolder folder;
    const Place place{kBin, folder.string(), kAddress, 1};
    Words command = linkCommand(place, preparePeer("dfclient", place), {});
    command.emplace_back("true");
    return runProgram(command).code == 0;
  }();
  return s_serves;
}

Figures measure(const std::string& program, const Condition& condition, const Effort& effort) {
  std::vector<std::future<Figures>> runs;
  for (int seed = 1; seed <= effort.seeds; ++seed) {
    runs.push_back(std::async(std::launch::async, runOnce, program, condition, effort,
                              static_cast<std::uint64_t>(seed)));
  }
  std::map<std::string, std::vector<double>> samples;
  for (auto& run : runs) {
    for (const auto& [key, value] : run.get()) samples[key].push_back(value);
  }
  Figures medians;
  for (const auto& [key, values] : samples) medians[key] = quantile(values, 0.5);
  return medians;
}

}  // namespace bench::path
