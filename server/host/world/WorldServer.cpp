#include "host/world/WorldServer.h"

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>

#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"
#include "host/world/DescriptorMessage.h"
#include "host/world/Determinism.h"
#include "host/world/FixedAddresses.h"
#include "host/world/WorldInProcess.h"
#include "host/world/WorldStart.h"

namespace naiad {

namespace {

bool isSocket(int descriptor) {
  struct stat facts {};
  return fstat(descriptor, &facts) == 0 && S_ISSOCK(facts.st_mode);
}

/// Receives a descriptor; below 0: none. Does not wait: the front sends it before the turn that needs it.
int receiveDescriptor(int from) {
  char byte = 0;
  int number = -1;
  return receiveDescriptors(from, &byte, 1, {&number, 1}, MSG_DONTWAIT) == 1 ? number : -1;
}

// Does not use fork(), whose handlers (pthread_atfork) are for programs that continue in both processes. The
// front checks that there are no threads before it requests a copy, so no missing thread holds a lock in it.
long forkBesideItself() {
  return syscall(SYS_clone, static_cast<unsigned long>(CLONE_PARENT | SIGCHLD), nullptr, nullptr, nullptr,
                 nullptr);
}

/// Waits until the copy is to take over. Returns false if it is not needed any more.
bool waitForTurn(int socket) {
  char byte = 0;
  ssize_t got = 0;
  while ((got = recv(socket, &byte, 1, MSG_PEEK)) < 0 && errno == EINTR) continue;
  return got == 1;
}

void beCopy(int socket, int world_socket, pid_t supervisor) {
  constexpr std::size_t kMaxNameSize = 16;
  char name[kMaxNameSize] = {};
  prctl(PR_GET_NAME, name);
  prctl(PR_SET_NAME, "df-copy");  // name in lists of processes
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != supervisor) _exit(0);
  // Copies survive the end of the world's process group, except in a sandbox, which refuses setsid().
  setsid();
  close(world_socket);
  const std::int32_t self = getpid();
  if (send(socket, &self, sizeof self, MSG_NOSIGNAL) != sizeof self || !waitForTurn(socket)) _exit(0);
  prctl(PR_SET_NAME, name);
}

bool receiveAll(int socket, char* to, std::size_t count) {
  while (count > 0) {
    const ssize_t got = ::recv(socket, to, count, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

WorldReady readyOf(const df::World& world) {
  WorldReady ready;
  ready.window_width = world.views().width();
  ready.window_height = world.views().height();
  if (const df::WorldExtras* p_extras = world.findExtras()) {
    ready.frame_millis = p_extras->settings.frame_time;
    ready.runs_empty = p_extras->settings.runs_empty;
  }
  ready.compat = world.compat();
  ready.help = world.getHelp();
  ready.files = popReadFiles();
  ready.fixed_addresses = hasFixedAddresses();
  return ready;
}

}  // namespace

CheckpointForker::CheckpointForker() {
  if (isSocket(kWorldCheckpoints)) m_request_socket = kWorldCheckpoints;
}

CheckpointForker::~CheckpointForker() {
  if (m_request_socket >= 0) close(m_request_socket);
}

// A world that died before it made the copy left its request to its successor, so only the newest one counts.
int CheckpointForker::receiveRequest() const {
  int newest = -1;
  for (int next = 0; (next = receiveDescriptor(m_request_socket)) >= 0;) {
    if (newest >= 0) close(newest);
    newest = next;
  }
  return newest;
}

std::optional<int> CheckpointForker::makeCopy(int world_socket) const {
  const int socket = m_request_socket >= 0 ? receiveRequest() : -1;
  if (socket < 0) return std::nullopt;
  const pid_t supervisor = getppid();
  if (forkBesideItself() == 0) {
    beCopy(socket, world_socket, supervisor);
    return socket;
  }
  close(socket);  // if the fork failed, this closes the last descriptor of this end, and the front notices
  return std::nullopt;
}

WorldServer::~WorldServer() {
  close();
}

void WorldServer::close() {
  if (m_socket >= 0) ::close(m_socket);
  m_socket = -1;
}

bool WorldServer::receive(std::string& fields) const {
  char head[kWorldFrameHead];
  if (!receiveAll(m_socket, head, sizeof head)) return false;
  const auto size = loadLittleEndian<std::uint32_t>(head);
  if (size > kMaxWorldFrame) return false;
  fields.resize(size);
  return receiveAll(m_socket, fields.data(), size);
}

bool WorldServer::send(const std::string& frame) const {
  for (std::size_t sent = 0; sent < frame.size();) {
    const ssize_t count = ::send(m_socket, frame.data() + sent, frame.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

void WorldServer::run(df::World& world) {
  world.input().setGameOverLeaves(m_leaves);
  writeReady(readyOf(world), m_frame);
  bool goes_on = send(m_frame);
  for (std::string fields; goes_on && receive(fields);) {
    bool copied = false;
    const auto turn = readTurnMessage(fields, m_turns, copied);
    if (!turn) {
      world.log().write("The host sent a malformed turn; the game is over.");
      break;
    }
    updateLagCompensation(*turn, world);
    setDeterminismTick(static_cast<std::uint32_t>(world.getStepCount()) + 1);
    applyTurn(*turn, world);
    world.tick();
    goes_on = sendAnswer(*turn, world) && !world.isGameOver();
    if (goes_on && copied) makeCopy();
  }
  world.setGameOver();
  world.input().setLagCompensation(nullptr);
  close();
}

// Forks a copy of this process if one was requested. In the copy, this returns only when the copy takes over,
// with a socket of its own.
void WorldServer::makeCopy() {
  if (const auto socket = m_checkpoints.makeCopy(m_socket)) m_socket = *socket;
}

void WorldServer::updateLagCompensation(const WorldTurn& turn, df::World& world) {
  const bool wanted = turn.watched && world.input().isLagCompensated();
  if (wanted == m_publisher.has_value()) return;
  wanted ? static_cast<void>(m_publisher.emplace()) : m_publisher.reset();
  m_lag_compensator = LagCompensator();
  world.input().setLagCompensation(wanted ? &m_lag_compensator : nullptr);
  world.store().setWatched(false);  // so that every Object counts as changed in the next view
}

bool WorldServer::sendAnswer(const WorldTurn& turn, df::World& world) {
  if (m_publisher) {
    m_publisher->update(world.picture().view());
    m_lag_compensator.recordTick(*m_publisher, world.picture().view());
  }
  if (!writeAnswer(popAnswer(turn, world), turn.watched ? &world.picture().view() : nullptr, m_views,
                   m_frame)) {
    world.log().write("The world does not fit in a frame of " + std::to_string(kMaxWorldFrame) +
                      " bytes; the game is over. dfserver --in-process has no such limit.");
    return false;
  }
  return send(m_frame);
}

}  // namespace naiad
