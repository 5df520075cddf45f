// Bytes in TLS on a TCP socket.
//
// OpenSSL reads from and writes to the socket itself: there is no buffer between the two, and an idle
// connection holds none of OpenSSL's either.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "shared/net/stream/ByteStream.h"
#include "shared/net/stream/PeerFacts.h"
#include "shared/net/stream/SocketBio.h"
#include "shared/net/stream/TlsContext.h"

struct ssl_st;

namespace naiad {

class TlsStream : public ByteStream {
 public:
  /// Client or server, as the context is. A client names the server it wants: a name goes into the hello
  /// (SNI, RFC 6066 3) and a name or address is what the certificate must be for. Throws TlsError if out of
  /// memory.
  TlsStream(Socket socket, std::shared_ptr<const TlsContext> context, const std::string& server_name = {},
            std::string peer = {});
  ~TlsStream() override;

  /// Go on with the handshake; kDone when it is complete. Before that, nothing else may be called. A server
  /// stops once with kWantsJudgement when the client's hello has come, all of it: nothing of the answer has
  /// been calculated, which takes a signature. The next call goes on.
  Outcome handshake();
  /// A client does.
  bool speaksFirst() const { return !context_->isServer(); }
  /// After a handshake that failed: why, as the end of a sentence ("it does not speak TLS").
  const std::string& problem() const { return problem_; }
  /// The peer closed the connection, or it broke.
  bool isHungUp() const { return bio_.ended || bio_.failed; }
  /// For a client after the handshake: what it proved about the server.
  std::optional<PeerFacts> peerFacts() const;

  Progress read(std::span<char> into) override;
  Progress write(std::string_view bytes) override;
  /// close_notify, and the end of the TCP stream.
  Outcome end() override;
  bool holdsInput() const override;
  std::string exportSecret(std::string_view label, std::string_view context,
                           std::size_t bytes) const override;

 private:
  struct Free {
    void operator()(ssl_st* ssl) const;
  };
  void expect(const std::string& server_name);
  Outcome outcomeOf(int result);
  void explain();

  std::shared_ptr<const TlsContext> context_;
  SocketBio bio_;
  std::unique_ptr<ssl_st, Free> ssl_;
  std::string problem_;
  bool hello_judged_ = false;
  bool end_sent_ = false;
};

}  // namespace naiad
