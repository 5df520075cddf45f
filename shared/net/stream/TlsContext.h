// What all TLS connections of one end share: protocol settings, a server's key, a client's trust store.
//
// TLS 1.3 (RFC 8446) and nothing older, ALPN "naiad/1" (RFC 7301) required at both ends. Web servers and
// clients of web servers are exceptions. No session tickets, no resumption, no early data, no client
// certificates. Made for many quiet connections: no read-ahead, and buffers are given back while they are
// empty.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

struct ssl_ctx_st;

namespace naiad {

/// The protocol that both ends must agree on.
inline constexpr std::string_view kAlpn = "naiad/1";
/// And that of browsers (RFC 7301 6).
inline constexpr std::string_view kHttpAlpn = "http/1.1";

/// Key, certificate or trust store cannot be used. what() is one sentence for people.
class TlsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Immutable; connections keep it alive. All on one thread.
class TlsContext {
 public:
  /// `certificate_pem`: the server's certificate, then those above it, if any. `key_pem`: its private key,
  /// without a password. Throws TlsError if they cannot be read or do not belong together.
  static std::shared_ptr<const TlsContext> forServer(const std::string& certificate_pem,
                                                     const std::string& key_pem);
  /// The same for browsers: TLS 1.3 as well, but "http/1.1" is the only protocol it agrees to, and a client
  /// may name none.
  static std::shared_ptr<const TlsContext> forWebServer(const std::string& certificate_pem,
                                                        const std::string& key_pem);
  /// Takes any server, and finds out about it (PeerFacts). Chains are checked against the system's trust
  /// store, or the PEM file `trust_file`. Throws TlsError if that file cannot be used.
  static std::shared_ptr<const TlsContext> forClient(const std::string& trust_file = {});
  /// Makes the context of a client of web servers: TLS 1.2 or 1.3, ALPN "http/1.1", which a server need not
  /// know. The handshake fails if the chain is not good in the eyes of the system's trust store
  /// (SSL_CERT_FILE and SSL_CERT_DIR replace it) or is for another host. Reading the store takes some 20 ms.
  static std::shared_ptr<const TlsContext> forWebClient();

  bool isServer() const { return is_server_; }
  /// The protocol that must have been agreed on by a handshake; empty: none need be.
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
