// The parts that libdragonfly-ops.so adds to a host (host/loop/OperatorLibrary.h).
#include <asio/ip/address.hpp>
#include <asio/post.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "host/admin/BanList.h"
#include "host/admin/ControlFile.h"
#include "host/admin/ControlSocket.h"
#include "host/loop/HostClients.h"
#include "host/loop/HostEndpoint.h"
#include "host/loop/HostPart.h"
#include "host/loop/OperatorLibrary.h"
#include "host/net/LanResponder.h"
#include "host/ops/AdminConsole.h"
#include "host/ops/ChatCommands.h"
#include "host/ops/HostAdmin.h"
#include "host/ops/HostFleet.h"
#include "host/ops/HostMetrics.h"
#include "host/ops/HostScores.h"
#include "host/ops/StatusFile.h"
#include "host/rooms/HostContext.h"
#include "host/session/CounterTable.h"
#include "host/world/Descendants.h"
#include "shared/admin/ControlPath.h"
#include "shared/net/lan/LanMessage.h"
#include "shared/net/stream/TcpListener.h"
#include "shared/program/JobThread.h"
#include "shared/program/PublishedFile.h"

namespace naiad {

namespace {

/// Accepts commands from the control socket and the chat, and carries them out on the host's thread.
class HostCommands : public HostPart {
 public:
  /// Opens the control socket (HostOptions::control) and makes the host refuse banned clients. Throws
  /// BanFileError, PasswordError, and ListenError if an explicitly given socket path cannot be used. If the
  /// default path cannot be used, only logs a warning.
  HostCommands(const HostAccess& access, HostScores& scores)
      : m_access(access),
        m_bans(m_worker, access.context.options.state),
        m_admin(access, scores),
        m_console(access.context, m_admin, m_worker, m_bans),
        m_chat(access, m_admin, m_console, m_bans) {
    access.endpoint.setBanCheck(
        [this](const asio::ip::address& address) { return m_bans.isBanned(address); });
    access.clients.admission().setBanCheck([this](const asio::ip::address& address, const std::string& name) {
      return m_bans.refusal(address, name);
    });
    access.clients.setCommands(
        [this](Session& session, const std::string& line) { m_chat.serve(session, line); });
    listen();
  }
  /// Calls finish().
  ~HostCommands() override { finish(); }

  void tick(Clock::time_point now) override { m_chat.update(now); }
  /// Stops accepting commands. Waits until accepted changes are written.
  void finish() override {
    // Closes the socket first, so that no command arrives while the worker finishes its jobs.
    m_control.reset();
    m_worker.finish();
  }

 private:
  void listen() {
    const HostOptions& options = m_access.context.options;
    const bool by_default = options.control.empty() && options.control_by_port;
    ControlSocketOptions where = listening(by_default);
    if (where.path.empty()) return;
    try {
      m_control = std::make_unique<ControlSocket>(std::move(where), executor(), m_access.context.feed,
                                                  m_access.context.log);
    } catch (const ListenError& error) {
      if (!by_default) throw;
      m_access.context.log({LogEvent::Level::kWarning, std::string("warning: ") + error.what() +
                                                           " dfctl cannot reach this server (--control)."});
    }
  }
  ControlSocketOptions listening(bool by_default) const {
    // Refuses world processes (descendants), and processes of PID namespaces that have no number in this one.
    ControlSocketOptions listening;
    listening.path = m_access.context.options.control;
    if (by_default) {
      listening.path = controlPath(m_access.endpoint.port()).value_or(std::filesystem::path());
      removeStaleControls(listening.path.parent_path());
    }
    listening.is_refused = [](pid_t process) { return process <= 0 || isDescendant(process); };
    return listening;
  }
  ControlSocket::Execute executor() {
    return [this](AdminRequest request, AdminCaller caller, std::function<void(AdminAnswer)> done) {
      asio::post(m_access.context.home,
                 [this, request = std::move(request), caller = std::move(caller), done = std::move(done)] {
                   m_console.execute(request, caller, done);
                 });
    };
  }

  HostAccess m_access;
  JobThread m_worker;
  BanList m_bans;  ///< the network thread calls isBanned()
  HostAdmin m_admin;
  AdminConsole m_console;
  ChatCommands m_chat;
  std::unique_ptr<ControlSocket> m_control;  ///< null: no control socket
};

/// Lets players find a server: in the local network (--lan), and by a file for server lists on the web
/// (--status-file). Thread: the host's.
class HostListing : public HostPart {
 public:
  static constexpr std::chrono::seconds kStatusInterval{5};

  /// Throws ListenError with --lan on if the socket for the network's queries cannot be opened, and
  /// std::runtime_error if the status file cannot be written.
  explicit HostListing(const HostAccess& access) : m_access(access), m_lan(openLan()) {
    const std::string& file = access.context.options.status_file;
    if (!file.empty()) m_status.emplace("status file", file, status());
  }

  /// Begins to answer queries in the local network.
  void begin() override {
    if (m_lan) m_lan->start();
  }
  /// Publishes the number of players.
  void tick(Clock::time_point now) override {
    if (m_lan) m_lan->setPlayers(m_access.clients.sessions().playingCount());
    if (!m_status) return;
    if (now - m_status_at >= kStatusInterval) {
      m_status_at = now;
      m_status->setText(status(), true);
    }
    if (const std::string news = m_status->popLogMessage(); !news.empty()) m_access.context.log(news);
  }
  /// Stops answering queries and removes the status file.
  void drain() override {
    if (m_lan) m_lan->stop();
    m_status.reset();
  }
  /// Logs the counters of the network's queries.
  void finish() override {
    if (!m_lan) return;
    const LanCounters lan = m_lan->counters();
    const std::string text = listCounters({{"answered", lan.answered},
                                           {"routed", lan.routed},
                                           {"foreign", lan.foreign},
                                           {"malformed", lan.malformed},
                                           {"rate_limited", lan.rate_limited},
                                           {"unsent", lan.unsent}});
    if (!text.empty()) m_access.context.log("local network: " + text);
  }

 private:
  std::unique_ptr<LanResponder> openLan() const {
    // A server without encryption is never listed. One on loopback is listed only with --lan on, because
    // other machines cannot reach it.
    const HostOptions& options = m_access.context.options;
    const bool automatic = options.lan == "auto";
    const bool loopback = asio::ip::make_address(options.address).is_loopback();
    const auto key = m_access.endpoint.fingerprint();
    if (!key || options.lan == "off" || (automatic && loopback)) return nullptr;
    try {
      const LanAnswer answer{m_access.clients.facts(), {}, m_access.endpoint.port(), ShortKey::of(*key)};
      return std::make_unique<LanResponder>(answer, options.address,
                                            automatic ? LanMode::kAuto : LanMode::kOn);
    } catch (const std::system_error& error) {
      const std::string wrong = std::string("cannot be found in the local network: ") + error.what();
      if (!automatic) throw ListenError("--lan on: the server " + wrong + ".", error.code());
      m_access.context.log({LogEvent::Level::kWarning, "warning: the server " + wrong});
      return nullptr;
    }
  }
  std::string status() const {
    const bool has_link = !m_access.context.options.link_host.empty();
    const auto link = has_link ? m_access.endpoint.joinLink(true) : std::nullopt;
    return statusText(m_access.clients.facts(), link ? link->text() : std::string());
  }

  HostAccess m_access;
  std::unique_ptr<LanResponder> m_lan;    ///< null: not visible in the local network
  std::optional<PublishedFile> m_status;  ///< nullopt: no --status-file, or removed
  Clock::time_point m_status_at = Clock::now();
};

}  // namespace

// The part for the fleet is last, because a platform may remove the server as soon as it is told of the end.
extern "C" void naiad_makeOperatorParts(const HostAccess& access,
                                        std::vector<std::unique_ptr<HostPart>>& parts) {
  auto scores = std::make_unique<HostScores>(access);
  HostScores& all_scores = *scores;
  parts.push_back(std::move(scores));
  parts.push_back(std::make_unique<HostCommands>(access, all_scores));
  parts.push_back(std::make_unique<HostListing>(access));
  if (!access.context.options.metrics.empty()) parts.push_back(std::make_unique<HostMetrics>(access));
  parts.push_back(std::make_unique<HostFleet>(access, all_scores));
}

}  // namespace naiad
