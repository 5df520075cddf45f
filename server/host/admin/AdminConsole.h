// Carries out commands, wherever they come from: the control socket, or the chat of an admin.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "host/admin/AdminTarget.h"
#include "host/admin/AdminWorker.h"
#include "host/admin/BanList.h"
#include "shared/admin/AdminRequest.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// Who gives a command.
struct AdminCaller {
  AdminCommand::Level level = AdminCommand::Level::kPlayer;
  AdminCommand::Place place = AdminCommand::Place::kChat;
  std::string name;           ///< for the log: `user 1000, process 4711`, `player "Ann" at 192.0.2.7:50312`
  std::string player{};       ///< of the chat: their name; empty: the server's console
  std::uint64_t session = 0;  ///< of the chat
};

/// On the host's thread. Each command of an admin is logged with who gave it, passwords as "***".
class AdminConsole {
 public:
  using Done = std::function<void(AdminAnswer)>;

  /// All of these outlive it. `post` runs a job on the host's thread, from any.
  struct Setup {
    AdminTarget& target;
    AdminWorker& worker;
    BanList& bans;
    LogLine log;
    std::function<void(std::function<void()> job)> post;
  };
  explicit AdminConsole(Setup setup) : m_setup(std::move(setup)) {}

  /// `done` is called once, on the host's thread: now, or later for what takes long.
  void execute(const AdminRequest& request, const AdminCaller& caller, Done done);

 private:
  AdminAnswer answerNow(const AdminRequest& request, const AdminCaller& caller);
  void changePassword(const AdminRequest& request, Done done);
  void reload(Done done);
  void scores(const AdminRequest& request, Done done);
  void answerSaved(const std::string& text, const std::string& problem, const Done& done);
  AdminAnswer listRooms() const;
  AdminAnswer listPlayers(const AdminCaller& caller) const;
  AdminAnswer tell(const AdminRequest& request, const AdminCaller& caller);
  AdminAnswer kick(const AdminRequest& request);
  AdminAnswer mute(const AdminRequest& request, bool muted);
  AdminAnswer restart(const AdminRequest& request);
  AdminAnswer set(const AdminRequest& request);
  void ban(const AdminRequest& request, const AdminCaller& caller, const Done& done);
  void unban(const AdminRequest& request, const Done& done);
  AdminAnswer listBans() const;
  void endBanned();

  Setup m_setup;
};

}  // namespace naiad
