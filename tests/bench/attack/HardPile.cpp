#include "HardPile.h"

#include <signal.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "PileServer.h"
#include "Programs.h"
#include "tests/terminal/PtyTerminal.h"

namespace bench::attack {

namespace {

using Clock = std::chrono::steady_clock;
using naiad::test::PtyTerminal;
using namespace std::chrono_literals;

constexpr auto kSendTime = 60s;  // for the server to send everything

/// Show the pile for a while, then `interrupt`: milliseconds until dfclient has ended.
double endAfter(const std::string& folder, std::chrono::milliseconds shown, PileResult& result,
                const std::function<void(PtyTerminal&)>& interrupt) {
  PileServer server(folder + "/identity");
  PtyTerminal terminal({.command = {clientProgram(), "127.0.0.1:" + std::to_string(server.port()),
                                    "--fingerprint", server.fingerprint(), "--known-servers",
                                    folder + "/known", "--no-resume", "--name", "victim"},
                        .environment = {{"HOME", folder}, {"XDG_STATE_HOME", folder}},
                        .columns = 80,
                        .rows = 24});
  for (const auto end = Clock::now() + kSendTime;
       server.sent() < PileServer::kObjects && !terminal.hasExited();) {
    if (Clock::now() > end) throw std::runtime_error("dfclient does not take in the pile");
    terminal.read(20ms);
  }
  result.objects = server.sent();
  for (const auto end = Clock::now() + shown; Clock::now() < end && !terminal.hasExited();)
    terminal.read(20ms);
  result.ended = result.ended || terminal.hasExited();
  const Clock::time_point asked = Clock::now();
  interrupt(terminal);
  while (!terminal.hasExited() && Clock::now() - asked < kPilePatience) terminal.read(5ms);
  return std::chrono::duration<double, std::milli>(Clock::now() - asked).count();
}

}  // namespace

PileResult runHardPile(std::chrono::seconds duration) {
  std::string folder = std::filesystem::temp_directory_path() / "naiad-attack-XXXXXX";
  if (mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no folder can be made");
  PileResult result;
  const auto shown = std::max<std::chrono::milliseconds>(duration / 2, 2s);
  result.sigterm_ms =
      endAfter(folder, shown, result, [](PtyTerminal& terminal) { terminal.signal(SIGTERM); });
  result.ctrl_c_ms = endAfter(folder, shown, result, [](PtyTerminal& terminal) { terminal.type("\x03"); });
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  return result;
}

}  // namespace bench::attack
