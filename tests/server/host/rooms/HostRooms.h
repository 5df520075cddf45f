// The rooms of a host without a network, and worlds for them.
#pragma once

#include <asio/io_context.hpp>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "host/admission/Admission.h"
#include "host/journal/DeterminismCheck.h"
#include "host/journal/Journal.h"
#include "host/journal/JournalSink.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/RoundRecovery.h"
#include "tests/server/host/rooms/Clients.h"

namespace naiad::test {

struct NoSink : JournalSink {
  void write(std::string_view /*bytes*/) override {}
  void sync() override {}
  void setFlags(std::uint16_t /*flags*/) override {}
};

/// Returns a journal, and a writer that does not have it, so that all records stay in the journal's ring.
inline Round::JournalBinding ringJournal() {
  Round::JournalBinding book;
  book.writer = std::make_shared<JournalWriter>();
  book.journal =
      std::make_shared<Journal>(std::make_unique<NoSink>(), DfrHeader(), DfrFacts(), 1 << 20, false);
  return book;
}

/// Records its turns, and answers what the test sets.
struct FakeWorld : WorldPort {
  bool isReady() const override { return true; }
  void tick(const SentTurn& turn) override {
    turns.push_back(turn);
    ++picture.tick;
    m_answer = std::exchange(next, {});
    reportTick();
  }
  std::uint32_t nextTick() const override { return picture.tick + 1; }
  const df::WorldView& view() const override { return picture; }
  std::optional<WorldEnd> end() const override { return ended; }
  void close(const WorldTurn& /*rest*/) override { ended = WorldEnd(); }

  std::vector<df::InputQueue::Input> inputs() const {
    std::vector<df::InputQueue::Input> all;
    for (const SentTurn& sent : turns)
      all.insert(all.end(), sent.turn.inputs.begin(), sent.turn.inputs.end());
    return all;
  }

  std::vector<SentTurn> turns;
  WorldAnswer next;  ///< returned for the next turn
  df::WorldView picture;
  std::optional<WorldEnd> ended;
};

/// The test advances the time. The rooms open when the first client connects.
struct HostRooms {
  HostRooms() {
    world.log().setSink([](const std::string&) {});
  }
  HostRooms(const HostRooms&) = delete;
  HostRooms& operator=(const HostRooms&) = delete;
  virtual ~HostRooms() = default;

  /// Opens the rooms if they are not open.
  Admission& admission() {
    if (!m_admission) {
      m_admission.emplace(Admission::Setup{context, sessions, rooms, news, prefixes,
                                           [](const ReliableChannel&, AeadId) { return nullptr; },
                                           [this](const wire::Welcome& welcome) -> Session& {
                                             Session& session = sessions.addDetached(now);
                                             session.restore(welcome, events());
                                             return session;
                                           }});
      rooms.open(world);
      m_admission->setWorld(world);
    }
    return *m_admission;
  }
  Client& greet(const wire::Hello& hello, const std::string& address = "192.0.2.1:1") {
    admission();
    Client& client = clients.emplace_back();
    client.address = address;
    sessions.add(std::make_unique<FakeChannel>(client), events(), now);
    client.greet(hello);
    return client;
  }
  static void leave(const Client& client) {
    client.leave();
    client.drop();
  }
  virtual Session::Events events() {
    return {
        [this](Session& session, const wire::Hello& hello) { m_admission->evaluateHello(session, hello); },
        [](Session&, const std::string&) {},
        [this](Session& session) {
          m_admission->forgetSession(session);
          if (session.player() != 0) rooms.leave(session);
        },
        [this] { return now; }};
  }

  std::vector<std::string> log;
  HostContext context{{}, "maze", [this](const LogEvent& event) { log.push_back(event.text); }};
  HostOptions& options = context.options;
  Counters& counters = context.counters;
  SessionTable::Clock::time_point now = SessionTable::Clock::now();
  df::World world;
  const df::World::Scope scope{world};
  PlayerPrefixes prefixes;
  std::deque<Client> clients;
  SessionTable sessions{1024, counters, [this](Session& session) { rooms.removeSession(session); }};
  RoomManager rooms{context, sessions, [] {}};
  PlayerListBroadcaster news;

 private:
  std::optional<Admission> m_admission;
};

}  // namespace naiad::test
