#include "host/ops/StatusFile.h"

#include "shared/json/Json.h"
#include "shared/values/Version.h"

namespace naiad {

std::string statusText(const ServerInfo& facts, const std::string& link) {
  Json status = jsonOf(facts);
  status.set("version", kVersion);
  if (!link.empty()) status.set("link", link);
  return status.toString(Json::Style::kAscii) + "\n";
}

}  // namespace naiad
