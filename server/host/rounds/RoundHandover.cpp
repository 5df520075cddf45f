#include "host/rounds/RoundHandover.h"

#include <sys/socket.h>

#include <algorithm>
#include <asio/ip/tcp.hpp>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "host/net/InheritedSockets.h"
#include "host/rounds/SandboxPolicy.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {

namespace {

using StreamEndpoint = asio::ip::tcp::endpoint;

int socketOption(int socket, int option) {
  int value = -1;
  socklen_t size = sizeof value;
  return getsockopt(socket, SOL_SOCKET, option, &value, &size) == 0 ? value : -1;
}

/// Returns the address of a socket; nullopt if it is not an IP socket.
std::optional<StreamEndpoint> boundTo(int socket) {
  StreamEndpoint endpoint;
  auto size = static_cast<socklen_t>(endpoint.capacity());
  if (getsockname(socket, endpoint.data(), &size) != 0) return std::nullopt;
  const int family = endpoint.data()->sa_family;
  if (family != AF_INET && family != AF_INET6) return std::nullopt;
  endpoint.resize(size);
  return endpoint;
}

std::vector<int> openDescriptors() {
  std::vector<int> numbers;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    if (const auto number = readNumber(entry.path().filename().string(), 0, INT_MAX))
      numbers.push_back(*number);
  }
  return numbers;
}

/// Returns the socket of this type on that port (and address, if given), for TCP a listening one; -1: none.
int findSocket(int type, std::uint16_t port, const std::optional<StreamEndpoint>& address) {
  for (const int socket : openDescriptors()) {
    const auto endpoint = boundTo(socket);
    if (!endpoint || endpoint->port() != port || socketOption(socket, SO_TYPE) != type) continue;
    if (type == SOCK_STREAM && socketOption(socket, SO_ACCEPTCONN) != 1) continue;
    if (!address || *endpoint == *address) return socket;
  }
  return -1;
}

// The listening sockets of this process, for the program that it runs next.

/// Returns copies of the socket that listens on this TCP port and of the one for datagrams on its address.
/// The copies stay open when the originals are closed; the caller must close them. Returns nullopt if this
/// process does not have both sockets, for example without encryption. Reads /proc.
std::optional<InheritedSockets> copyListeningSockets(std::uint16_t port) {
  InheritedSockets sockets;
  sockets.streams = findSocket(SOCK_STREAM, port, std::nullopt);
  if (sockets.streams < 0) return std::nullopt;
  const auto endpoint = boundTo(sockets.streams);
  sockets.datagrams = findSocket(SOCK_DGRAM, port, endpoint);
  if (sockets.datagrams < 0) return std::nullopt;
  sockets.address = endpoint->address().to_string();
  sockets.port = port;
  return sockets.duplicate();
}

/// Time limit to write a round to disk for dfreplay. The game continues, and other programs may use the disk.
constexpr std::chrono::seconds kSyncTime{20};
/// Time limit of a program that only reads its options.
constexpr std::chrono::seconds kCheckTime{20};
constexpr std::size_t kMaxProblem = 200;

constexpr std::string_view kProtocolKey = " protocol=";

/// Returns the last line that begins with `begin`; if `begin` is empty, the last line that is not empty.
std::string lineWith(const std::string& text, std::string_view begin) {
  std::istringstream lines(text);
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.starts_with(begin)) found = line;
  }
  return found;
}

/// Returns the last line, as the rest of a sentence.
std::string lastWords(const std::string& output_text) {
  std::string last = lineWith(output_text, "");
  while (last.ends_with('.')) last.pop_back();
  return safeText(last, kMaxProblem);
}

std::string protocolProblem(const std::string& verified) {
  const std::size_t at = verified.find(kProtocolKey);
  if (at == std::string::npos) return "it does not report its protocol version";
  const long protocol = std::strtol(verified.c_str() + at + kProtocolKey.size(), nullptr, 10);
  if (protocol == long{kProtocolVersion}) return {};
  return "it uses protocol " + std::to_string(protocol) + ", but the players' clients use " +
         std::to_string(kProtocolVersion);
}

/// Describes the end of a program that did not exit by itself; empty if it did.
std::string abruptEnd(const std::string& name, const ChildExit& end) {
  if (end.timed_out) return name + " timed out";
  if (end.signal != 0) return name + " was killed by signal " + std::to_string(end.signal);
  if (end.code == ChildExit::kNotStarted) return name + " cannot be started";
  return {};
}

std::chrono::milliseconds timeFor(const RoundJournals::CurrentRound& round) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const std::chrono::nanoseconds played =
      std::max(std::chrono::nanoseconds(0), now - std::chrono::nanoseconds(round.start_nanos));
  const auto time = RoundHandover::kMinTime +
                    std::chrono::duration_cast<std::chrono::seconds>(played / RoundHandover::kPartOfRound);
  return std::min<std::chrono::milliseconds>(time, RoundHandover::kMaxTime);
}

/// Returns the reason `why` with the room's name, if it has one; empty if there is no reason.
std::string inRoom(const std::string& name, const std::string& why) {
  return why.empty() || name.empty() ? why : "room " + name + ": " + why;
}

}  // namespace

std::string parseVerifyResult(const ChildExit& end) {
  if (std::string abrupt = abruptEnd("dfreplay", end); !abrupt.empty()) return abrupt;
  if (end.code == 0) return protocolProblem(lineWith(end.output_text, "verified "));
  const std::string tick = end.code == 1 ? lineWith(end.output_text, "tick ") : std::string();
  if (!tick.empty()) return safeText(tick, kMaxProblem);
  const std::string last = lastWords(end.output_text);
  return last.empty() ? "dfreplay ended with code " + std::to_string(end.code) : last;
}

RoundHandover::RoundHandover(const ReexecCommand& command, std::vector<Room> rooms)
    : m_command(command), m_rooms(std::move(rooms)) {}

RoundHandover::~RoundHandover() {
  m_run.cancel();
  if (m_thread.joinable()) m_thread.join();
}

std::string RoundHandover::blocker() const {
  if (m_verifying) return "a handover is already in progress";
  bool is_any = false;
  for (const Room& room : m_rooms) {
    if (const std::string why_not = room.journals->handoverBlocker(); !why_not.empty())
      return inRoom(room.name, why_not);
    is_any = is_any || room.journals->currentRound();
  }
  return is_any ? std::string() : "no round is being recorded";
}

// Blocks signals in the new thread, because the thread that ticks handles them.
void RoundHandover::verify(std::function<void(const Result& result)> done) {
  if (m_thread.joinable()) m_thread.join();  // the thread of an earlier proof, which has ended
  m_verifications.clear();
  for (const Room& room : m_rooms) {
    if (const auto round = room.journals->currentRound()) m_verifications.push_back({&room, *round});
  }
  m_verifying = true;
  m_thread = startWithoutSignals([this, done = std::move(done)] {
    const Result result = execute();
    m_verifying = false;
    done(result);
  });
}

RoundHandover::Result RoundHandover::execute() {
  if (const std::string problem = problemOfProgram(); !problem.empty()) return {problem, false};
  for (Verification& proof : m_verifications) {
    if (const std::string problem = problemOf(proof); !problem.empty())
      return {inRoom(proof.p_room->name, problem)};
  }
  return {};
}

// Checks that the new program starts. One that ended at once, because it cannot be loaded or has other
// options, would end the game.
std::string RoundHandover::problemOfProgram() {
  std::vector<std::string> arguments = withoutPasswords(m_command.arguments());
  arguments.emplace_back("--check-config");
  const ChildExit end = m_run.run(m_command.program(), arguments, kCheckTime);
  if (std::string abrupt = abruptEnd("dfserver", end); !abrupt.empty()) return abrupt;
  if (end.code == 0) return {};
  return "the installed dfserver rejects this server's options: " + safeText(end.output_text, kMaxProblem);
}

std::string RoundHandover::problemOf(Verification& proof) {
  RoundJournals& journals = *proof.p_room->journals;
  if (!journals.sync(kSyncTime)) return "the disk is too slow";
  proof.module_hash = hashOfModule(journals.module());
  const std::string replay = std::filesystem::path(m_command.program()).replace_filename("dfreplay").string();
  return parseVerifyResult(
      m_run.run(replay, {proof.round.file, "--verify", "--for-server", "--game", journals.module()},
                timeFor(proof.round)));
}

std::string RoundHandover::changeSinceVerification() const {
  for (const Room& room : m_rooms) {
    if (const std::string why_not = room.journals->handoverBlocker(); !why_not.empty())
      return inRoom(room.name, why_not);
    const auto round = room.journals->currentRound();
    if (!round) continue;
    const bool is_proven =
        std::any_of(m_verifications.begin(), m_verifications.end(),
                    [&round](const Verification& proof) { return proof.round.uuid == round->uuid; });
    if (!is_proven) return inRoom(room.name, "a new round began during the check");
  }
  for (const Verification& proof : m_verifications) {
    if (hashOfModule(proof.p_room->journals->module()) != proof.module_hash)
      return inRoom(proof.p_room->name, "the game was replaced during the check");
  }
  return {};
}

void RoundHandover::suspend(std::uint16_t port) {
  m_sockets = copyListeningSockets(port);
  for (const Room& room : m_rooms) room.journals->suspend();
}

void RoundHandover::exportRounds() const {
  HandedOverRounds rounds;
  for (const Verification& proof : m_verifications) rounds[proof.round.uuid] = proof.module_hash;
  RoundJournals::exportHandedOverRounds(rounds);
}

}  // namespace naiad
