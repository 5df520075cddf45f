// The settings that all TLS connections of one end share: protocol, a server's key, a client's trust store.
//
// Only TLS 1.3 (RFC 8446), and ALPN "naiad/1" (RFC 7301) required at both ends; web servers and their clients
// are exceptions. No session tickets, no resumption, no early data, no client certificates. For many quiet
// connections: no read-ahead, and empty buffers are freed.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

struct ssl_ctx_st;

namespace naiad {

/// ALPN name of the protocol that both ends must agree on.
inline constexpr std::string_view kAlpn = "naiad/1";
/// ALPN name of the protocol of browsers (RFC 7301 6).
inline constexpr std::string_view kHttpAlpn = "http/1.1";

/// Thrown if a key, certificate, trust store or server name is unusable, memory runs out, or OpenSSL lacks a
/// feature. what() is one sentence for people.
class TlsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Immutable; connections keep it alive. All its connections must be on one thread.
class TlsContext {
 public:
  /// `certificate_pem`: the server's certificate, then those above it, if any. `key_pem`: its private key,
  /// without a password. Throws TlsError if they are invalid or do not match.
  static std::shared_ptr<const TlsContext> forServer(const std::string& certificate_pem,
                                                     const std::string& key_pem);
  /// Like forServer(), for browsers: also TLS 1.3, but "http/1.1" is the only accepted protocol, and clients
  /// may name none.
  static std::shared_ptr<const TlsContext> forWebServer(const std::string& certificate_pem,
                                                        const std::string& key_pem);
  /// Accepts any server and collects facts about it (PeerIdentity). Chains are checked against the system's
  /// trust store, or the PEM file `trust_file`. Throws TlsError if that file is unusable.
  static std::shared_ptr<const TlsContext> forClient(const std::string& trust_file = {});
  /// Returns a context for clients of web servers: TLS 1.2 or 1.3, ALPN "http/1.1", which a server need not
  /// know. The handshake fails if the chain does not verify with the system's trust store (SSL_CERT_FILE and
  /// SSL_CERT_DIR replace it) or is for another host. Reading the store takes about 20 ms.
  static std::shared_ptr<const TlsContext> forWebClient();

  bool isServer() const { return is_server_; }
  /// The protocol on which a handshake must agree; empty: none.
  std::string_view requiredAlpn() const { return required_alpn_; }
  ssl_ctx_st* get() const { return context_.get(); }

 private:
  struct Free {
    void operator()(ssl_ctx_st* context) const;
  };
  explicit TlsContext(bool is_server);
  void useCertificate(const std::string& pem);
  void useKey(const std::string& pem);
  void choose(const std::string_view& protocol);
  void offer(std::string_view protocol);

  std::unique_ptr<ssl_ctx_st, Free> context_;
  bool is_server_;
  std::string_view required_alpn_ = kAlpn;
};

}  // namespace naiad
