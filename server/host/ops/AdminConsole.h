// Carries out commands, wherever they come from: the control socket, or the chat of an admin.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/admin/AdminPlayer.h"
#include "host/admin/AdminWorker.h"
#include "host/admin/BanList.h"
#include "host/ops/HostAdmin.h"
#include "host/rooms/HostContext.h"
#include "shared/admin/AdminAnswer.h"
#include "shared/admin/AdminRequest.h"

namespace naiad {

/// Which player somebody means who types #ID, a name, or the beginning of one.
struct PlayerChoice {
  std::optional<AdminPlayer> player;  ///< nothing: `problem` says why
  AdminAnswer problem{};
};

/// In this order: #ID, which is never a name, so that a player who is called "#7" shields nobody; the whole
/// name; the whole name but for the case of letters; its beginning. Several that fit equally well are an
/// error that lists them.
PlayerChoice choosePlayer(const std::vector<AdminPlayer>& players, const std::string& typed);

/// On the host's thread. Each command of an admin is logged with who gave it, passwords as "***".
class AdminConsole {
 public:
  using Done = std::function<void(AdminAnswer)>;

  /// All of these outlive it.
  AdminConsole(HostContext& context, HostAdmin& admin, AdminWorker& worker, BanList& bans)
      : m_context(context), m_admin(admin), m_worker(worker), m_bans(bans) {}

  /// `done` is called once, on the host's thread: now, or later for what takes long.
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
  void endBanned();

  void post(std::function<void()> job);

  HostContext& m_context;
  HostAdmin& m_admin;
  AdminWorker& m_worker;
  BanList& m_bans;
};

}  // namespace naiad
