// Keys, certificates and TLS contexts for tests. Made with OpenSSL directly, once per process.
#pragma once

#include <memory>
#include <string>

#include "shared/net/stream/TlsContext.h"

namespace naiad::test {

/// A certificate with its key, PEM.
struct TestIdentity {
  std::string certificate;
  std::string key;

  /// For `host` (a DNS name), signed by itself, or by `authority`.
  static TestIdentity make(const std::string& host, const TestIdentity* authority = nullptr);
};

/// One that tests share, for "naiad.test", signed by itself.
const TestIdentity& testIdentity();
std::shared_ptr<const TlsContext> testServerContext();
std::shared_ptr<const TlsContext> testClientContext();

}  // namespace naiad::test
