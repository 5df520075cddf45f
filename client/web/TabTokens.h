// The token of the session that a browser's tab plays, kept by its page.
#pragma once

#include <string>
#include <string_view>

#include "client/trust/TokenStore.h"
#include "client/web/WebPort.h"

namespace naiad {

/// There is one server, the one behind the gateway, so its key is not looked at. Not thread-safe.
class TabTokens : public TokenStore {
 public:
  /// `kept`: what the page kept for this tab, hexadecimal; anything else counts as nothing.
  TabTokens(WebPort& port, std::string_view kept);

  std::string tokenFor(const Fingerprint&) const override { return m_token; }
  void save(SavedSession session, Time now) override;
  void refresh(Time) override {}
  void remove() override;

 private:
  WebPort& m_port;
  std::string m_token;
};

}  // namespace naiad
