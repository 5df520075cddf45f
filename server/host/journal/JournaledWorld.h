// A world whose turns are journaled: each is stored before the world gets it, and what came of it after.
//
// With a RoundRecovery it first gets the turns of a round whose server was killed, as fast as it answers, and
// is ready when it has had all of them. In the same way another world takes over from one that crashed or
// hangs, without the keys and clicks of the tick in which that happened: a copy of it that is a few seconds
// old, or one that begins again.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/journal/CopyMarks.h"
#include "host/journal/Journal.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/RepeatCheck.h"
#include "host/journal/RoundRecovery.h"
#include "host/journal/TurnRecord.h"
#include "host/world/WorldPort.h"

namespace naiad {

class JournaledWorld : public WorldPort {
 public:
  using Clock = std::chrono::steady_clock;

  /// Ticks between two hashes of the state, and between two pictures, of which the first comes earlier. A
  /// picture takes some 500 bytes of the file, a hash 8.
  static constexpr std::uint32_t kHashTicks = 30;
  static constexpr std::uint32_t kPictureTicks = 900;
  static constexpr std::uint32_t kFirstPicture = 300;

  /// A second death within so many ticks of the first one is the same: the round is over.
  static constexpr std::uint32_t kSameDeath = 30;
  /// Bytes of records that are kept for another world: days. A longer round ends with its world.
  static constexpr std::size_t kMaxHistory = std::size_t{64} << 20;

  /// Scores of a recovery's turns that are kept: those before them are in the server's file.
  static constexpr std::size_t kMaxScores = 4096;

  /// Another world of the same round, and what is to be called when it has had its turns: what it prints
  /// until then was printed.
  struct AnotherWorld {
    std::unique_ptr<WorldPort> world;
    std::function<void()> on_repeated;
  };

  /// Where it is written, and what is to be said of it.
  struct Book {
    std::shared_ptr<JournalWriter> writer;
    std::shared_ptr<Journal> journal;
    /// More facts, once the world has begun; empty: there are none.
    std::function<DfrFacts()> late_facts;
    /// The journal has stopped, and why; the game goes on.
    std::function<void(const std::string& problem)> on_problem;
    std::unique_ptr<RepeatCheck> check = nullptr;       ///< whether the game is repeatable; null: unchecked
    std::unique_ptr<RoundRecovery> recovery = nullptr;  ///< null: the round begins
    /// Of a recovery, once the world has begun: why it is not the world that the file has; empty: it is.
    std::function<std::string()> find_difference = {};
    /// Of a recovery, at its end: in how many ticks; or why the round cannot go on, and in which tick that
    /// showed.
    std::function<void(std::uint32_t ticks, const std::string& problem)> on_recovered = {};
    std::string recording = {};    ///< the file, from the folder of --journal
    std::string history = {};      ///< records of a recovery's round
    std::uint32_t first_tick = 0;  ///< the number that the host gave to its first tick; 0: unknown
    /// Starts one; throws std::system_error. Empty: the round ends with its world.
    std::function<AnotherWorld()> new_world = {};
    /// The world has ended so in this tick. `goes_on`: another one takes over.
    std::function<void(const WorldEnd& end, std::uint32_t tick, bool goes_on)> on_death = {};
    /// Another world has taken over, and how long that took.
    std::function<void(const TakeOver& done, std::chrono::milliseconds time)> on_taken_over = {};
    /// A sentence about copies, for the log.
    std::function<void(const std::string& sentence)> on_copies = {};
  };

  JournaledWorld(std::unique_ptr<WorldPort> world, Book book);
  /// A round that has not come to its end was stopped.
  ~JournaledWorld() override;
  JournaledWorld(const JournaledWorld&) = delete;
  JournaledWorld& operator=(const JournaledWorld&) = delete;

  std::uint32_t addInput(df::InputQueue::Input input) override;
  void setHeard(std::uint32_t player) override;
  void endGame() override;
  bool isReady() const override { return !m_book.recovery && m_world->isReady(); }
  void setPictured(std::uint32_t player) override;
  void tick(bool watched, bool truth) override;
  std::uint32_t nextTick() const override { return isTakingOver() ? m_next_tick : m_world->nextTick(); }
  const df::WorldView& view() const override { return isTakingOver() ? m_view : m_world->view(); }
  void notePublished(const Publisher& publisher) override { m_world->notePublished(publisher); }
  std::vector<std::uint32_t> takeLeavers() override { return m_world->takeLeavers(); }
  std::vector<df::AddedScore> takeScores() override;
  std::vector<df::SentPlayer> takeSent() override { return m_world->takeSent(); }
  RoundName roundName() const override;
  bool isGameOver() const override { return m_world->isGameOver(); }
  df::Canvas renderPlayer(std::uint32_t player) const override { return m_world->renderPlayer(player); }
  void checkProcess(std::uint32_t tick) override;
  std::optional<int> recovering() const override;
  std::optional<std::vector<KeptSession>> takeSessions() override {
    return std::exchange(m_sessions, std::nullopt);
  }
  void noteSession(const KeptSession& session) override;
  std::optional<WorldEnd> end() const override { return m_unrecovered ? m_unrecovered : m_world->end(); }
  std::optional<std::string> takeWarning() override { return m_world->takeWarning(); }
  void close() override { m_world->close(); }
  std::optional<TakeOver> takeTakeOver() override { return std::exchange(m_taken_over, std::nullopt); }

 private:
  void begin();
  void choosePicture();
  void storeTurn();
  void storeResult();
  void store();
  void finish(const std::string& why);
  void noteInput(const df::InputQueue::Input& input);
  void repeatTurns();
  void sendTurn(const WorldTurn& turn);
  void closeRecovery();
  void endRepeatedTick();
  void keepRepeatedScores();
  void endRecovery(const std::string& problem);
  void listenToWorld();
  bool isTakingOver() const { return m_death.has_value(); }
  std::uint32_t currentTick() const;
  bool takeOver(const WorldEnd& end);
  bool beginAgain(bool drops_keys);
  bool repeatByCopy();
  bool repeatByAnother();
  void prepareToRepeat(std::size_t records);
  void orderCopy();
  void say(const std::string& sentence_of_copies) const;
  void endTakeOver(const std::string& problem);

  std::unique_ptr<WorldPort> m_world;
  Book m_book;
  bool m_goes_on = true;  ///< the journal
  bool m_began = false;
  std::uint32_t m_later = 0;             ///< the host's tick numbers minus the world's own
  std::uint32_t m_ticks = 0;             ///< begun, of this world
  std::uint32_t m_pictured = 0;          ///< whom the host wants to see
  std::uint32_t m_recorded = 0;          ///< whose picture the tick that is under way gives; 0: none
  std::vector<std::uint32_t> m_players;  ///< that have joined and not left, in order
  WorldTurn m_turn;
  WorldTurn m_sent;  ///< of the tick that is under way, for the check
  TurnRecordWriter m_writer;
  std::string m_record;

  // Of a recovery.
  bool m_repeating = false;        ///< it has begun
  std::uint32_t m_unanswered = 0;  ///< turns that the world was sent
  bool m_closing = false;          ///< the world has been sent the turn behind those of the file
  std::optional<std::vector<KeptSession>> m_sessions;
  std::vector<df::AddedScore> m_scores;  ///< of repeated turns, which the server may not know
  std::optional<WorldEnd> m_unrecovered;

  // Of a world that takes over.
  bool m_in_tick = false;
  std::string m_history;                   ///< all records; empty: they are too many
  std::optional<WorldEnd> m_death;         ///< of the world before, while another one has its turns
  std::optional<std::uint32_t> m_died_at;  ///< tick
  std::function<void()> m_on_repeated;
  std::uint32_t m_next_tick = 0;
  df::WorldView m_view;
  Clock::time_point m_death_at;
  std::optional<TakeOver> m_taken_over;

  // Of copies.
  CopyMarks m_copies;
  bool m_by_copy = false;  ///< the world that has the turns again is one
};

}  // namespace naiad
