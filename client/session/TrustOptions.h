// The options of the client programs that say whom to trust and how to be let in.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "client/session/Connection.h"

namespace naiad {

inline void addTrustOptions(CLI::App& app, ServerTrust& trust, SessionOptions& session) {
  app.add_option_function<std::string>(
         "--fingerprint",
         [&trust](const std::string& text) {
           trust.fingerprint = Fingerprint::parse(text);
           if (!trust.fingerprint) {
             throw CLI::ValidationError("--fingerprint",
                                        "64 hexadecimal digits are wanted, as dfserver prints them");
           }
         },
         "The server's key, as dfserver prints it: no other is trusted")
      ->type_name("HEX")
      ->envname("NAIAD_FINGERPRINT");
  app.add_option(
         "--known-servers", trust.known_servers,
         "File of the keys of servers seen before (default: naiad/known_servers in your data directory)")
      ->type_name("FILE")
      ->envname("NAIAD_KNOWN_SERVERS");
  app.add_option("--password", session.password,
                 "The server's password (other users see the command line: rather set NAIAD_PASSWORD)")
      ->envname("NAIAD_PASSWORD");
  app.add_flag("--insecure", trust.insecure, "Without encryption, to a server on this machine (for tests)")
      ->envname("NAIAD_INSECURE");
}

}  // namespace naiad
