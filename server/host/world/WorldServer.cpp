#include "host/world/WorldServer.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"
#include "host/world/FixedStart.h"
#include "host/world/Repeatable.h"
#include "host/world/WorldInProcess.h"

namespace naiad {

namespace {

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
  ready.files = takeReadFiles();
  ready.fixed_addresses = hasFixedAddresses();
  return ready;
}

}  // namespace

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
    setRepeatTick(static_cast<std::uint32_t>(world.getStepCount()) + 1);
    applyTurn(*turn, world);
    world.tick();
    goes_on = sendAnswer(*turn, world) && !world.isGameOver();
    if (goes_on && copied) makeCopy();
  }
  world.setGameOver();
  world.input().setLagCompensation(nullptr);
  close();
}

// The copy comes here when it is to go on: in the same place, with another socket.
void WorldServer::makeCopy() {
  if (const auto socket = m_copies.makeCopy(m_socket)) m_socket = *socket;
}

void WorldServer::updateLagCompensation(const WorldTurn& turn, df::World& world) {
  const bool wanted = turn.watched && world.input().isLookingBack();
  if (wanted == m_publisher.has_value()) return;
  wanted ? static_cast<void>(m_publisher.emplace()) : m_publisher.reset();
  m_lag_compensator = LagCompensator();
  world.input().setLagCompensation(wanted ? &m_lag_compensator : nullptr);
  world.store().setWatched(false);  // the next view has every Object as changed
}

bool WorldServer::sendAnswer(const WorldTurn& turn, df::World& world) {
  if (m_publisher) {
    m_publisher->update(world.picture().view());
    m_lag_compensator.recordTick(*m_publisher, world.picture().view());
  }
  if (!writeAnswer(takeAnswer(turn, world), turn.watched ? &world.picture().view() : nullptr, m_views,
                   m_frame)) {
    world.log().write("The world does not fit in a frame of " + std::to_string(kMaxWorldFrame) +
                      " bytes; the game is over. dfserver --in-process has no such bound.");
    return false;
  }
  return send(m_frame);
}

}  // namespace naiad
