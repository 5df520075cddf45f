// A host as commands see it (AdminTarget.h).
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/admin/AdminTarget.h"
#include "host/loop/HostPart.h"
#include "host/ops/HostScores.h"
#include "host/session/Session.h"

namespace naiad {

/// On the host's thread.
class HostAdmin : public AdminTarget {
 public:
  /// What it works with outlives it.
  HostAdmin(const HostAccess& access, HostScores& scores);

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
    std::vector<std::string> rooms;
  };
  std::vector<Board> boards() const;
  /// Null: `refusal` says why there is none, or that there are several.
  static const Board* findBoard(const std::vector<Board>& boards, const AdminScores& which,
                                AdminAnswer& refusal);
  Session* findPlaying(std::uint64_t session) const;

  HostAccess m_access;
  HostScores& m_scores;
  Session::Clock::time_point m_began;
};

}  // namespace naiad
