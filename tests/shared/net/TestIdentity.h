// Keys, certificates and TLS contexts for tests, made directly with OpenSSL, once per process.
#pragma once

#include <memory>
#include <string>

#include "shared/net/stream/TlsContext.h"

namespace naiad::test {

/// A certificate and its key in PEM.
struct TestIdentity {
  std::string certificate;
  std::string key;

  /// Makes an identity for `host` (a DNS name), signed by `authority` or, if that is null, by itself.
  static TestIdentity make(const std::string& host, const TestIdentity* authority = nullptr);
};

/// Returns a self-signed identity for "naiad.test" that the tests share.
const TestIdentity& testIdentity();
std::shared_ptr<const TlsContext> testServerContext();
std::shared_ptr<const TlsContext> testClientContext();

}  // namespace naiad::test
