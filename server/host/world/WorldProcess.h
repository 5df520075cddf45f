// A world in a process of its own, over a Unix socket (WorldMessages.h). The other end is a WorldServer.
//
// A world that does not answer in time, or sends a malformed frame, is killed; one that crashes has ended.
// The host goes on without it. Of a tick only that time counts which is the world's own doing (TickEffort.h):
// a machine under load and a debugger do not make a game hang.
#pragma once

#include <asio/io_context.hpp>
#include <asio/local/stream_protocol.hpp>
#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/world/ActivityPage.h"
#include "host/world/OutputRelay.h"
#include "host/world/TickEffort.h"
#include "host/world/WorldCopies.h"
#include "host/world/WorldLauncher.h"
#include "host/world/WorldMessages.h"
#include "host/world/WorldPort.h"

namespace naiad {

/// WorldPort::answerHash() of an answer's fields.
std::uint64_t hashAnswer(std::string_view fields);

class WorldProcess : public WorldPort {
 public:
  using Clock = std::chrono::steady_clock;

  /// So many times StartedWorld::hang_time for an answer, and it is killed: a game may load something once in
  /// a while. After one time takeWarning() says that it hangs.
  static constexpr int kPatience = 5;
  /// From the start of the process to GM.run(), and for the first tick.
  static constexpr std::chrono::seconds kStartTime{30};
  /// From the end of the game to that of its process: what main() does after GM.run().
  static constexpr std::chrono::seconds kEndTime{1};
  /// Keys and clicks that wait for a world, at most; those beyond are dropped.
  static constexpr std::size_t kMaxInputs = 16'384;
  /// Of turnsAhead(): some milliseconds of most games.
  static constexpr std::uint32_t kTurnsAhead = 32;

  /// Takes over the process and the descriptors. `home` runs its handlers. `print`: gets the lines that it
  /// prints, from checkProcess(); empty: they are dropped.
  WorldProcess(asio::io_context& home, const StartedWorld& started, OutputRelay::Line print = {});
  /// Kills it and all that it has started, if it has not ended.
  ~WorldProcess() override;
  WorldProcess(const WorldProcess&) = delete;
  WorldProcess& operator=(const WorldProcess&) = delete;

  std::uint32_t addInput(df::InputQueue::Input input) override;
  void setHeard(std::uint32_t player) override { m_turn.heard_player = player; }
  void endGame() override { m_turn.ends_game = true; }
  bool isReady() const override { return m_state == State::kReady; }
  void setPictured(std::uint32_t player) override { m_pictured = player; }
  void setChecked(bool state) override {
    m_hashes = true;
    m_turn.checked = state;
  }
  std::uint64_t answerHash() const override { return m_answer_hash; }
  std::optional<std::uint64_t> stateHash() const override { return m_answer.state_hash; }
  std::uint32_t turnsAhead() const override { return kTurnsAhead; }
  void tick(bool watched, bool truth) override;
  /// Before the first tick: that of the host's. From there on it counts its own.
  std::uint32_t nextTick() const override { return m_next_tick; }
  const df::WorldView& view() const override { return m_view; }
  /// Lag compensation is done in the world's own process.
  void notePublished(const Publisher& /*publisher*/) override {}
  std::vector<std::uint32_t> takeLeavers() override;
  std::vector<df::AddedScore> takeScores() override;
  std::vector<df::SentPlayer> takeSent() override;
  bool isGameOver() const override { return m_answer.game_over; }
  df::Canvas renderPlayer(std::uint32_t player) const override;
  void checkProcess(std::uint32_t tick) override;
  std::optional<WorldEnd> end() const override { return m_end; }
  std::optional<std::string> takeWarning() override { return std::exchange(m_warning, std::nullopt); }
  void close() override;
  bool keepCopy() override;
  std::chrono::nanoseconds cpuTime() const override;
  std::optional<std::string> takeCopyProblem() override;
  std::optional<std::uint32_t> goOnWithCopy() override;
  void endRepetition() override;
  void giveUp(const std::string& why) override { fail(WorldEnd::kCrashed, why); }

  /// What the game has set up by GM.run(); nothing before.
  const std::optional<WorldReady>& ready() const { return m_ready; }

 private:
  enum class State {
    kStarting,
    kReady,
    kTicking,
    kEnding,  ///< the socket is closed, or will be, and the process comes to its end
    kEnded,
  };

  void beginTick();
  void sendTurns();
  void readHead();
  void readFields();
  void onFrame();
  void takeReady();
  void hangUp();
  void fail(WorldEnd::Why why, const std::string& text);
  void finish(int status);
  WorldEnd endOf(int status) const;
  std::string when() const;
  std::string activity(std::string_view verb) const;
  std::vector<std::string> lastLines() const;
  void readKeeper(int patience_millis);
  template <class Message>
  std::optional<Message> takeFromKeeper(int patience_millis);
  std::chrono::nanoseconds patience() const;
  bool isInFirstTick() const { return currentTick() == m_later + 1; }
  /// The one that the world is at, or was at last.
  std::uint32_t currentTick() const;
  void countTime(Clock::time_point now);
  void warnOfHang();
  void kill();
  void killWorld();
  void waitForKeeper();
  bool orderToGoOn(const WorldCopy& copy);
  void become(WorldCopy copy);

  asio::local::stream_protocol::socket m_socket;
  int m_keeper;  ///< the socket of its keeper
  OutputRelay::Line m_print;
  OutputRelay m_output;
  const df::ActivityPage* m_p_page = nullptr;  ///< null: there is none
  const std::chrono::nanoseconds m_hang_time;
  bool m_started = false;  ///< as the keeper says
  pid_t m_process = -1;    ///< the same
  State m_state = State::kStarting;
  std::optional<WorldReady> m_ready;
  std::optional<int> m_status;        ///< once it has ended
  bool m_keeper_ended = false;        ///< and with it all that the world had started
  std::optional<WorldEnd> m_failure;  ///< why it was killed
  std::optional<WorldEnd> m_end;
  Clock::time_point m_checked_at;
  std::chrono::nanoseconds m_waited{0};  ///< in this state; time between two checks counts up to a limit
  TickEffort m_effort;                   ///< of the tick that is under way
  std::uint32_t m_next_tick = 1;
  std::uint32_t m_pictured = 0;
  std::uint32_t m_later = 0;  ///< the host's tick numbers minus the world's own
  bool m_began = false;
  bool m_warned = false;      ///< of this tick, that it hangs
  bool m_stop_noted = false;  ///< of this tick, that it is stopped
  std::optional<std::string> m_warning;
  bool m_expected = false;  ///< to end: the game is over, or the host closed it
  bool m_hashes = false;    ///< the next turn's answer is to be hashed
  std::uint64_t m_answer_hash = 0;
  WorldTurn m_turn;  ///< the next one
  /// Of a turn that was sent and not answered.
  struct SentTurn {
    bool hashed = false;
    bool copied = false;
  };
  std::deque<SentTurn> m_sent;
  std::string m_frame;
  std::string m_unsent;
  std::string m_out;  ///< that is being sent
  bool m_sending = false;
  std::string m_in;
  std::optional<ViewReader> m_views;
  df::WorldView m_view;
  WorldAnswer m_answer;
  WorldCopies m_copies;
  bool m_copies_now = false;  ///< behind the next turn
  bool m_repeats = false;     ///< what it prints was printed
  std::shared_ptr<WorldProcess*> m_self = std::make_shared<WorldProcess*>(this);  ///< handlers may come later
};

}  // namespace naiad
