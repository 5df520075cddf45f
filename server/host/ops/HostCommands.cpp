#include "host/ops/HostCommands.h"

#include <asio/post.hpp>
#include <filesystem>
#include <utility>

#include "host/admin/ControlFile.h"
#include "host/loop/HostClients.h"
#include "host/loop/HostEndpoint.h"
#include "host/world/Descendants.h"
#include "shared/admin/ControlPath.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {

HostCommands::HostCommands(const HostAccess& access, HostScores& scores)
    : m_access(access),
      m_bans(m_worker, access.context.options.state),
      m_admin(access, scores),
      m_console(access.context, m_admin, m_worker, m_bans),
      m_chat(access, m_admin, m_console, m_bans) {
  access.endpoint.setBans([this](const asio::ip::address& address) { return m_bans.isBanned(address); });
  access.clients.admission().setBans([this](const asio::ip::address& address, const std::string& name) {
    return m_bans.refusal(address, name);
  });
  access.clients.setCommands(
      [this](Session& session, const std::string& line) { m_chat.serve(session, line); });
  listen();
}

HostCommands::~HostCommands() {
  finish();
}

// Answers of the worker go to the socket's clients.
void HostCommands::finish() {
  m_control.reset();
  m_worker.finish();
}

void HostCommands::listen() {
  const HostOptions& options = m_access.context.options;
  const bool by_default = options.control.empty() && options.control_by_port;
  ControlListening where = listening(by_default);
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

// A world must not give orders, nor hide in a namespace from where its process has no number here.
ControlListening HostCommands::listening(bool by_default) const {
  ControlListening listening;
  listening.path = m_access.context.options.control;
  if (by_default) {
    listening.path = controlPath(m_access.endpoint.port()).value_or(std::filesystem::path());
    removeStaleControls(listening.path.parent_path());
  }
  listening.is_refused = [](pid_t process) { return process <= 0 || isDescendant(process); };
  return listening;
}

ControlSocket::Execute HostCommands::executor() {
  return [this](AdminRequest request, AdminCaller caller, std::function<void(AdminAnswer)> done) {
    asio::post(m_access.context.home, [this, request = std::move(request), caller = std::move(caller),
                                       done = std::move(done)] { m_console.execute(request, caller, done); });
  };
}

}  // namespace naiad
