#include "client/session/TrustOptions.h"

namespace naiad {

Option serverOption(std::string& server) {
  Option option{"server", &server, "Where the server is: HOST[:PORT], [::1]:PORT (port 9876 by default)",
                "NAIAD_SERVER"};
  option.type = "HOST[:PORT]";
  return option;
}

std::vector<Option> trustOptions(ServerTrust& trust, SessionOptions& session) {
  const StoreText store_fingerprint = [&trust](const std::string& text) -> std::string {
    trust.fingerprint = Fingerprint::parse(text);
    return trust.fingerprint ? "" : "64 hexadecimal digits are wanted, as dfserver prints them";
  };
  std::vector<Option> options = {
      {"--fingerprint", store_fingerprint, "The server's key, as dfserver prints it: no other is trusted",
       "NAIAD_FINGERPRINT"},
      {"--known-servers", &trust.known_servers,
       "File of the keys of servers seen before (default: naiad/known_servers in your data directory)",
       "NAIAD_KNOWN_SERVERS"},
      {"--password", &session.password,
       "The server's password (other users see the command line: rather set NAIAD_PASSWORD)",
       "NAIAD_PASSWORD"},
      {"--insecure", &trust.insecure, "Without encryption, to a server on this machine (for tests)",
       "NAIAD_INSECURE"}};
  options[0].type = "HEX";
  options[1].type = "FILE";
  return options;
}

}  // namespace naiad
