#include "shared/fleet/BusSettings.h"

namespace naiad {

std::string busComplaint(const BusSettings& settings) {
#ifndef NAIAD_NATS
  return "--bus: this program was built without NATS (Debian: libnats-dev)";
#endif
  const std::string& url = settings.url;
  const std::string scheme = settings.isEncrypted() ? "tls://" : "nats://";
  if (!url.starts_with(scheme) || url.size() == scheme.size())
    return "--bus: nats://HOST:PORT or tls://HOST:PORT is wanted";
  if (!settings.isEncrypted() && !settings.authorities.empty())
    return "--bus-ca is for tls://, not for nats://";
  return "";
}

}  // namespace naiad
