// A host as commands see it (AdminTarget.h).
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/admin/AdminTarget.h"
#include "host/admission/Admission.h"
#include "host/net/NetworkThread.h"
#include "host/process/Ending.h"
#include "host/rooms/Rooms.h"
#include "host/rooms/SessionTable.h"
#include "host/scores/ScoreKeeper.h"
#include "host/session/Counters.h"
#include "host/settings/HostOptions.h"

namespace naiad {

/// What ends a server or reads its options again: its host.
struct AdminControls {
  std::function<void(Ending::Plan plan)> end;
  std::function<void(std::function<void()> job)> post;  ///< run it on the host's thread; from any
  std::function<bool()> cancel_end;                     ///< false: nothing was planned
  std::function<void(std::function<void(bool is_done, const std::string& sentence)> done)> reload;
  std::function<void(std::function<void(bool is_done, const std::string& sentence)> done)> keep_round;
  std::function<void(const HostOptions& options)> take_over;  ///< those that may change while it runs
};

/// On the host's thread.
class HostAdmin : public AdminTarget {
 public:
  /// What it works with; all of it outlives this.
  struct Setup {
    const HostOptions& options;
    const SessionTable& sessions;
    const Rooms& rooms;
    Admission& admission;
    const Counters& counters;
    const NetworkThread& network;
    ScoreKeeper& scores;
    AdminControls controls;
  };
  explicit HostAdmin(Setup setup);

  std::vector<AdminPlayer> players() const override;
  AdminRow status() const override;
  std::vector<AdminRow> rooms() const override;
  void endPlayer(std::uint64_t session, const std::string& sentence) override;
  void say(const std::string& text) override;
  void tell(std::uint64_t session, const std::string& text) override;
  void setMuted(std::uint64_t session, bool muted) override;
  AdminAnswer stop(const std::string& sentence) override;
  AdminAnswer restart(const AdminRestart& restart) override;
  void keepRound(std::function<void(AdminAnswer)> done) override;
  AdminAnswer drain(std::optional<std::chrono::seconds> most) override;
  AdminAnswer cancel() override;
  void reload(std::function<void(AdminAnswer)> done) override;
  AdminAnswer changePassword(std::optional<PasswordHash> hash) override;
  void scores(const AdminScores& which, std::function<void(AdminAnswer)> done) override;
  AdminAnswer set(const std::string& option, const std::string& value) override;
  AdminRow settings() const override;

 private:
  /// The tables of a game, and the rooms that play it; without rooms those of the one game.
  struct Board {
    std::string game;
    ScoreKeeper* p_scores = nullptr;
    std::vector<std::string> rooms;
  };
  std::vector<Board> boards() const;
  /// Null: `refusal` says why there is none, or that there are several.
  static const Board* findBoard(const std::vector<Board>& boards, const AdminScores& which,
                                AdminAnswer& refusal);
  Session* findPlaying(std::uint64_t session) const;

  Setup m_setup;
  Session::Clock::time_point m_began;
};

}  // namespace naiad
