// naiad_link: runs a server and a client in two networks, joined by a link with delay, loss and a
// rate. Both ends are tun devices, and the packets pass through this process. So any protocol can be
// measured, by all users that may create namespaces.
//
//     network of the server                               network of the client
//     link0 10.77.0.1  <-- down: packets to the client --  link0 10.77.0.2
//
// This program runs as three processes: the first one waits; its child is the first process of a process
// namespace and carries the packets, so that all processes end with it; the parents of server and client move
// into their network and execute the command.
#include "Link.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "../SharedFile.h"
#include "Namespace.h"
#include "tests/bench/Guarded.h"
#include "tests/support/Text.h"

namespace {

using namespace bench::path;

constexpr int kFailed = 1;
constexpr int kNotAllowed = 77;
const std::string kSeparator = ":::";
constexpr Nanoseconds kRound{10'000'000};  // time between two checks whether children have ended
constexpr Nanoseconds kServerStarts{15'000'000'000};

struct Options {
  bool check = false;
  std::string server_address = "10.77.0.1";
  std::string client_address = "10.77.0.2";
  double delay_ms = 0;
  double loss_percent = 0;
  double rate_kbit_s = 0;
  std::uint64_t seed = 1;
  bool block_udp = false;
  std::string counters;
  std::string ready_file;
  std::string server_log = "/dev/null";
  std::vector<std::string> server;
  std::vector<std::string> client;
};

naiad::LinkConditions conditionsOf(const Options& options) {
  return {.delay = std::chrono::microseconds(static_cast<std::int64_t>(options.delay_ms * 1000)),
          .loss = options.loss_percent / 100,
          .rate = static_cast<std::uint64_t>(options.rate_kbit_s * 1000 / 8)};
}

/// Collects all ended children. Returns the exit code of `child` if it has ended.
std::optional<int> reap(pid_t child) {
  std::optional<int> code;
  int status = 0;
  for (pid_t pid = waitpid(-1, &status, WNOHANG); pid > 0; pid = waitpid(-1, &status, WNOHANG)) {
    if (pid == child) code = WIFEXITED(status) ? WEXITSTATUS(status) : kFailed;
  }
  return code;
}

bool isThere(const std::string& file) {
  return file.empty() || access(file.c_str(), F_OK) == 0;
}

int carry(const Options& options) {
  const NetworkNamespace client_network(options.client_address, options.server_address);
  const NetworkNamespace server_network(options.server_address, options.client_address);
  if (options.check) return 0;
  const auto counters = SharedFile<LinkCounters>::create(options.counters);
  Link link(server_network.tun(), client_network.tun(), conditionsOf(options), options.block_udp,
            options.seed, *counters);
  becomePunctual();
  const pid_t server = server_network.start(options.server, options.server_log);
  const Nanoseconds late = monotonicNow() + kServerStarts;
  while (!isThere(options.ready_file)) {
    // Success is not a failure here, because the command may have left a server in the background.
    const bool failed = reap(server).value_or(0) != 0;
    if (failed || monotonicNow() > late) {
      throw std::runtime_error("the server did not start: " + naiad::test::contentOf(options.server_log));
    }
    link.run(kRound);
  }
  const pid_t client = client_network.start(options.client, "");
  for (;;) {
    link.run(kRound);
    if (const auto code = reap(client)) return *code;
  }
}

/// Returns what `work` returns. If it is not allowed on this machine, prints why and returns kNotAllowed.
template <class Work>
int ifAllowed(Work work) {
  try {
    return work();
  } catch (const NotAllowed& reason) {
    std::printf("%s\n", reason.what());
    return kNotAllowed;
  }
}

int runAlone(const Options& options) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // kills this process when its parent ends
  unshareProcesses();
  const pid_t child = fork();
  if (child < 0) return kFailed;
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int code = bench::guarded("naiad_link", [&] { return ifAllowed([&] { return carry(options); }); });
    std::fflush(stdout);
    _exit(code);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : kFailed;
}

/// Splits the arguments "own options ::: server ::: client" into three parts.
std::vector<std::vector<std::string>> cut(int argc, char** argv) {
  std::vector<std::vector<std::string>> parts(1);
  for (int i = 1; i < argc; ++i) {
    if (argv[i] == kSeparator) {
      parts.emplace_back();
    } else {
      parts.back().emplace_back(argv[i]);
    }
  }
  return parts;
}

int start(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Runs a server and a client with a bad network between them:\n"
      "naiad_link [OPTIONS] ::: SERVER [ARGUMENT...] ::: CLIENT [ARGUMENT...]",
      "naiad_link");
  app.add_flag("--check", options.check, "Only see whether this machine allows it; prints why not");
  app.add_option("--server-address", options.server_address, "IPv4 address of the server's end");
  app.add_option("--client-address", options.client_address, "IPv4 address of the client's end");
  app.add_option("--delay-ms", options.delay_ms, "One way, in both directions")
      ->check(CLI::Range(0.0, 10000.0));
  app.add_option("--loss-percent", options.loss_percent, "Each way, of each packet")
      ->check(CLI::Range(0.0, 100.0));
  app.add_option("--rate-kbit", options.rate_kbit_s, "Each way, with a 64 KiB drop-tail queue; 0: no limit")
      ->check(CLI::Range(0.0, 1e7));
  app.add_option("--seed", options.seed, "Of the losses");
  app.add_flag("--block-udp", options.block_udp, "Drop UDP, in both directions");
  app.add_option("--counters", options.counters, "File for the counters (LinkCounters)");
  app.add_option("--ready-file", options.ready_file, "The client starts when this file is there");
  app.add_option("--server-log", options.server_log, "File for what the server prints");
  app.footer("Exit codes: the client's; 1 the server did not start; 2 wrong usage; 77 not allowed here.");
  auto parts = cut(argc, argv);
  try {
    std::vector<std::string> reversed(parts[0].rbegin(), parts[0].rend());
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const bool complete =
      parts.size() == 3 && !parts[1].empty() && !parts[2].empty() && !options.counters.empty();
  if (!options.check && !complete) {
    std::fputs(app.help().c_str(), stderr);
    return 2;
  }
  if (parts.size() == 3) {
    options.server = parts[1];
    options.client = parts[2];
  }
  return ifAllowed([&] { return runAlone(options); });
}

}  // namespace

int main(int argc, char** argv) {
  return bench::guarded("naiad_link", [&] { return start(argc, argv); });
}
