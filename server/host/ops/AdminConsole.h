// Carries out commands from the control socket and from the chat.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/admin/AdminPlayer.h"
#include "host/admin/BanList.h"
#include "host/ops/HostAdmin.h"
#include "host/rooms/HostContext.h"
#include "shared/admin/AdminAnswer.h"
#include "shared/admin/AdminRequest.h"
#include "shared/program/JobThread.h"

namespace naiad {

/// The result of resolvePlayer().
struct PlayerLookup {
  std::optional<AdminPlayer> player;  ///< nullopt: `problem` has the reason
  AdminAnswer problem{};
};

/// Finds the player meant by a typed #ID, name, or beginning of a name. A text of the form #ID is never tried
/// as a name, so a player named "#7" cannot protect player 7. Otherwise tries the exact name, then the name
/// ignoring case, then its beginning. If several players match equally well, `problem` lists them.
PlayerLookup resolvePlayer(const std::vector<AdminPlayer>& players, const std::string& typed);

/// Carries out commands on the host's thread. Logs refused commands, and commands for admins or from the
/// control socket that change anything, with the caller; passwords as "***".
class AdminConsole {
 public:
  using Done = std::function<void(AdminAnswer)>;

  /// All arguments must outlive the console.
  AdminConsole(HostContext& context, HostAdmin& admin, JobThread& worker, BanList& bans)
      : m_context(context), m_admin(admin), m_worker(worker), m_bans(bans) {}

  /// Carries out a command. Calls `done` once, on the host's thread: at once, or later if it takes long.
  void execute(const AdminRequest& request, const AdminCaller& caller, Done done);

 private:
  AdminAnswer answerNow(const AdminRequest& request, const AdminCaller& caller);
  void changePassword(const AdminRequest& request, Done done);
  void reload(Done done);
  void scores(const AdminRequest& request, Done done);
  void answerSaved(const std::string& text, const std::string& problem, const Done& done);
  AdminAnswer listPlayers(const AdminCaller& caller) const;
  AdminAnswer tell(const AdminRequest& request, const AdminCaller& caller);
  AdminAnswer kick(const AdminRequest& request);
  AdminAnswer mute(const AdminRequest& request, bool muted);
  AdminAnswer restart(const AdminRequest& request);
  AdminAnswer set(const AdminRequest& request);
  void ban(const AdminRequest& request, const AdminCaller& caller, const Done& done);
  void unban(const AdminRequest& request, const Done& done);
  AdminAnswer listBans() const;
  void kickBanned();

  void post(std::function<void()> job);

  HostContext& m_context;
  HostAdmin& m_admin;
  JobThread& m_worker;
  BanList& m_bans;
};

}  // namespace naiad
