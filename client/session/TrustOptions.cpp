#include "client/session/TrustOptions.h"

#include <algorithm>
#include <variant>

#include "shared/net/base/SafeText.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/net/stream/ProxyHeader.h"

namespace naiad {
namespace {

constexpr std::size_t kMaxShown = 100;  // characters of the user's text that a message quotes

std::string quoted(const std::string& text) {
  return "\"" + safeText(text, kMaxShown) + "\"";
}

bool namesAnotherKey(const ServerTrust& trust, const ShortKey& key) {
  return trust.fingerprint && ShortKey::of(*trust.fingerprint) != key;
}

std::string followLink(const JoinLink& link, ServerAddress& address, ServerTrust& trust,
                       SessionOptions& session) {
  if (trust.insecure) return "--insecure cannot be used with a link, which contains the server's key.";
  if (namesAnotherKey(trust, link.key))
    return "--fingerprint (or NAIAD_FINGERPRINT) differs from the key in the link.";
  session.room = link.room;
  address = {link.address.host, link.address.port};
  trust.link_key = link.key;
  return {};
}

/// Sets the key that a listed server must have, if its address has an IPv6 zone, which links cannot express.
std::string followList(const ShortKey& key, ServerTrust& trust) {
  if (trust.insecure) return "--insecure cannot be used with a list, which contains the servers' keys.";
  if (namesAnotherKey(trust, key))
    return "--fingerprint (or NAIAD_FINGERPRINT) differs from the key in the list.";
  trust.link_key = key;
  return {};
}

std::string applyVisit(const ServerChoice& server, const ServerTrust& trust, SessionOptions& session) {
  if (server.visitors.empty() && server.visitor.empty()) return {};
  if (server.visitors.empty() || server.visitor.empty())
    return "--proxy-socket and --proxy-for must be used together.";
  if (trust.insecure) return "--proxy-socket cannot be used with --insecure.";
  const auto visitor = proxiedPeerFromText(server.visitor);
  if (!visitor) return quoted(server.visitor) + " is not a valid --proxy-for: expected ADDRESS:PORT.";
  session.proxy = ProxyOptions{server.visitors, *visitor};
  return {};
}

}  // namespace

bool ServerChoice::dropsPassword() const {
  return is_password_ambient &&
         (list_key || JoinLink::looksLikeLink(text) || GatewayAddress::looksLikeLink(text));
}

Option serverOption(ServerChoice& server) {
  Option option{"server", &server.text,
                "Server to join: a link (naiad://…), HOST[:PORT][/ROOM] or [IPV6]:PORT (default port 9876), "
                "or the address of its page for browsers (https://…)",
                "NAIAD_SERVER"};
  option.type = "SERVER";
  return option;
}

std::vector<Option> trustOptions(ServerChoice& server, ServerTrust& trust, SessionOptions& session) {
  const StoreText store_fingerprint = [&trust](const std::string& text) -> std::string {
    trust.fingerprint = Fingerprint::parse(text);
    return trust.fingerprint ? "" : "expected 64 hexadecimal digits, as dfserver prints them";
  };
  std::vector<Option> options = {
      {"--fingerprint", store_fingerprint, "The server's key, as dfserver prints it; no other key is trusted",
       "NAIAD_FINGERPRINT"},
      {"--known-servers", &trust.known_servers,
       "File with the keys of known servers (default: naiad/known_servers in your data directory)",
       "NAIAD_KNOWN_SERVERS"},
      {"--password", &session.password,
       "The server's password (other users can see the command line; NAIAD_PASSWORD is safer, but is not "
       "sent to servers from links, pages and lists)",
       "NAIAD_PASSWORD"},
      {"--no-redirect", &trust.ignore_redirects, "Do not follow redirects (from a lobby or a full server)",
       "NAIAD_NO_REDIRECT"},
      {"--insecure", &trust.insecure,
       "Connect without encryption, only to a server on this machine (for tests)", "NAIAD_INSECURE"}};
  const std::vector<Option> doors = {
      {"--proxy-socket", &server.visitors,
       "For doors: join through this visitors' socket of a server on this machine (dfserver --proxy-socket)"},
      {"--proxy-for", &server.visitor, "With --proxy-socket: the player's address, ADDRESS:PORT"}};
  options[0].type = "HEX";
  options[1].type = "FILE";
  options[2].p_from_environment = &server.is_password_ambient;
  options.insert(options.end(), doors.begin(), doors.end());
  return options;
}

std::string resolveServer(const ServerChoice& server, ServerAddress& address, ServerTrust& trust,
                          SessionOptions& session) {
  if (server.dropsPassword()) session.password.clear();
  if (std::string wrong = applyVisit(server, trust, session); !wrong.empty()) return wrong;
  if (GatewayAddress::looksLikeLink(server.text)) {
    if (trust.insecure || trust.fingerprint || session.proxy)
      return "--insecure, --fingerprint and --proxy-socket cannot be used with a gateway (https://…).";
    trust.gateway = GatewayAddress::parse(server.text);
    if (!trust.gateway)
      return quoted(server.text) + " is not a valid gateway address: expected https://HOST[:PORT]/.";
    address = {trust.gateway->host, trust.gateway->port};
    return {};
  }
  if (!JoinLink::looksLikeLink(server.text)) {
    const std::size_t slash = std::min(server.text.find('/'), server.text.size());
    const auto parsed = ServerAddress::parse(server.text.substr(0, slash));
    if (!parsed)
      return quoted(server.text) +
             " is not a valid server: expected a link (naiad://… or https://…) or HOST[:PORT][/ROOM].";
    address = *parsed;
    const std::string room = server.text.substr(std::min(slash + 1, server.text.size()));
    if (slash < server.text.size() && !isRoomName(room))
      return quoted(room) + " is not a valid room name: expected " + kRoomNameRule + ".";
    session.room = room;
    return server.list_key ? followList(*server.list_key, trust) : "";
  }
  const auto parsed = JoinLink::parse(server.text);
  if (const auto* p_problem = std::get_if<LinkError>(&parsed))
    return quoted(server.text) + " is not a valid link: " + p_problem->message + ".";
  return followLink(std::get<JoinLink>(parsed), address, trust, session);
}

}  // namespace naiad
