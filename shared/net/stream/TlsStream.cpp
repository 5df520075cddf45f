#include "shared/net/stream/TlsStream.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <utility>

namespace naiad {
namespace {

using asio::ip::tcp;

/// True if the ends agreed on the protocol `required`; if that is empty, on any protocol or none.
bool negotiated(const SSL* ssl, std::string_view required) {
  const unsigned char* data = nullptr;
  unsigned int size = 0;
  SSL_get0_alpn_selected(ssl, &data, &size);
  return required.empty() || std::string_view(reinterpret_cast<const char*>(data), size) == required;
}

std::string inWords(unsigned long error, const SSL* ssl) {
  switch (ERR_GET_REASON(error)) {
    case SSL_R_WRONG_VERSION_NUMBER:
    case SSL_R_HTTP_REQUEST:
    case SSL_R_UNEXPECTED_MESSAGE:
    case SSL_R_RECORD_LENGTH_MISMATCH:
    case SSL_R_PACKET_LENGTH_TOO_LONG:
      return "it does not speak TLS";
    case SSL_R_UNSUPPORTED_PROTOCOL:
    case SSL_R_TLSV1_ALERT_PROTOCOL_VERSION:
      return SSL_get_min_proto_version(const_cast<SSL*>(ssl)) == TLS1_3_VERSION ? "it does not speak TLS 1.3"
                                                                                : "it does not speak TLS 1.2";
    case SSL_R_CERTIFICATE_VERIFY_FAILED:
      return X509_verify_cert_error_string(SSL_get_verify_result(ssl));
    case SSL_R_TLSV1_ALERT_NO_APPLICATION_PROTOCOL:
    case SSL_R_NO_APPLICATION_PROTOCOL:
    case SSL_R_CALLBACK_FAILED:  // judgeHello() failed
      return "it does not speak " + std::string(kAlpn);
    default:
      const char* reason = ERR_reason_error_string(error);
      return reason ? std::string("TLS: ") + reason : "the TLS handshake failed";
  }
}

}  // namespace

using asio::ip::tcp;

TlsHandshake::TlsHandshake(std::unique_ptr<TlsStream> stream)
    : stream_(std::move(stream)), timer_(stream_->socket().get_executor()) {}

void TlsHandshake::run(std::chrono::milliseconds timeout, Done done, std::function<void()> on_hello) {
  done_ = std::move(done);
  on_hello_ = std::move(on_hello);
  setTimeout(timeout);
  // OpenSSL's first call allocates memory: wait until an idle client has sent something.
  await(stream_->isClient() ? tcp::socket::wait_write : tcp::socket::wait_read);
}

void TlsHandshake::setTimeout(std::chrono::milliseconds timeout) {
  timer_.start(timeout, [self = shared_from_this()] { self->finish(End::kTimedOut); });
}

void TlsHandshake::readAhead() {
  std::error_code error;
  if (!done_ || stream_->socket().available(error) == 0) return;
  ++waits_;  // ends the current wait: step() begins another one
  stream_->socket().cancel(error);
  step();
}

void TlsHandshake::step() {
  if (!done_) return;
  const auto self = shared_from_this();  // a callback may drop the last reference
  auto outcome = stream_->handshake();
  if (outcome == ByteStream::Outcome::kWantsApproval) {
    if (on_hello_) std::exchange(on_hello_, nullptr)();
    if (!done_) return;
    outcome = stream_->handshake();
  }
  if (outcome == ByteStream::Outcome::kDone) return finish(End::kDone);
  if (outcome != ByteStream::Outcome::kWantsRead && outcome != ByteStream::Outcome::kWantsWrite) {
    return finish(stream_->isDisconnected() ? End::kDisconnected : End::kFailed);
  }
  await(outcome == ByteStream::Outcome::kWantsWrite ? tcp::socket::wait_write : tcp::socket::wait_read);
}

void TlsHandshake::await(tcp::socket::wait_type readiness) {
  stream_->socket().async_wait(readiness,
                               [self = shared_from_this(), number = ++waits_](const std::error_code&) {
                                 if (number == self->waits_) self->step();
                               });
}

void TlsHandshake::finish(End end) {
  if (!done_) return;
  const Done call = std::exchange(done_, nullptr);
  on_hello_ = nullptr;
  timer_.cancel();
  const std::string problem = stream_->problem();
  auto stream = std::move(stream_);
  if (end != End::kDone) stream.reset();  // disconnects
  call(end, std::move(stream), problem);
}

void TlsHandshake::cancel() {
  if (!std::exchange(done_, nullptr)) return;
  on_hello_ = nullptr;
  timer_.cancel();
  std::error_code ignored;
  stream_->socket().close(ignored);
}

void TlsStream::Free::operator()(ssl_st* ssl) const {
  SSL_free(ssl);
}

TlsStream::TlsStream(Socket socket, std::shared_ptr<const TlsContext> context, const std::string& server_name,
                     std::string peer)
    : ByteStream(std::move(socket), std::move(peer)),
      context_(std::move(context)),
      ssl_(SSL_new(context_->get())) {
  bio_.socket = this->socket().native_handle();
  BIO* const bio = ssl_ ? bio_.make() : nullptr;
  if (!bio) throw TlsError("No memory for a TLS connection.");
  SSL_set_bio(ssl_.get(), bio, bio);  // takes ownership
  if (context_->isServer()) {
    bio_.guard.emplace();
    SSL_set_app_data(ssl_.get(), &hello_approved_);  // for judgeHello() in TlsContext.cpp
    SSL_set_accept_state(ssl_.get());
  } else {
    SSL_set_connect_state(ssl_.get());
    expect(server_name);
  }
}

TlsStream::~TlsStream() = default;

void TlsStream::expect(const std::string& server_name) {
  X509_VERIFY_PARAM* const wanted = SSL_get0_param(ssl_.get());
  X509_VERIFY_PARAM_set_hostflags(wanted, X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
  if (X509_VERIFY_PARAM_set1_ip_asc(wanted, server_name.c_str()) == 1) return;
  ERR_clear_error();
  const std::string name =
      server_name.ends_with('.') ? server_name.substr(0, server_name.size() - 1) : server_name;
  const bool good = !name.empty() && SSL_set_tlsext_host_name(ssl_.get(), name.c_str()) == 1 &&
                    X509_VERIFY_PARAM_set1_host(wanted, name.c_str(), name.size()) == 1;
  if (!good) throw TlsError("\"" + server_name + "\" is not a valid server name.");
}

ByteStream::Outcome TlsStream::handshake() {
  ERR_clear_error();
  const int result = SSL_do_handshake(ssl_.get());
  if (result != 1) return outcomeOf(result);
  bio_.guard.reset();
  if (negotiated(ssl_.get(), context_->requiredAlpn())) return Outcome::kDone;
  problem_ = "it does not speak " + std::string(kAlpn);
  return Outcome::kGarbage;
}

std::optional<PeerIdentity> TlsStream::peerIdentity() const {
  const X509* const certificate = SSL_get0_peer_certificate(ssl_.get());
  if (context_->isServer() || !certificate) return std::nullopt;
  const long verdict = SSL_get_verify_result(ssl_.get());
  const bool verifies = verdict == X509_V_OK;
  return PeerIdentity{Fingerprint::of(*certificate), verifies,
                      verifies ? "" : X509_verify_cert_error_string(verdict)};
}

ByteStream::Progress TlsStream::read(std::span<char> into) {
  ERR_clear_error();
  std::size_t size = 0;
  const int result = SSL_read_ex(ssl_.get(), into.data(), into.size(), &size);
  if (result == 1) return {Outcome::kDone, size};
  return {outcomeOf(result)};
}

ByteStream::Progress TlsStream::write(std::string_view bytes) {
  ERR_clear_error();
  std::size_t size = 0;
  const int result = SSL_write_ex(ssl_.get(), bytes.data(), bytes.size(), &size);
  if (result == 1) return {Outcome::kDone, size};
  return {outcomeOf(result)};
}

ByteStream::Outcome TlsStream::end() {
  if (!end_sent_) {  // because a second SSL_shutdown() would read
    ERR_clear_error();
    const int result = SSL_shutdown(ssl_.get());
    if (result < 0) return outcomeOf(result);
    end_sent_ = true;
  }
  std::error_code error;
  socket().shutdown(tcp::socket::shutdown_send, error);
  return error ? Outcome::kBroken : Outcome::kDone;
}

bool TlsStream::hasBufferedInput() const {
  return SSL_pending(ssl_.get()) > 0;  // not SSL_has_pending(), which counts incomplete records
}

std::string TlsStream::exportSecret(std::string_view label, std::string_view context,
                                    std::size_t bytes) const {
  std::string secret(bytes, '\0');
  const int result = SSL_export_keying_material(
      ssl_.get(), reinterpret_cast<unsigned char*>(secret.data()), secret.size(), label.data(), label.size(),
      reinterpret_cast<const unsigned char*>(context.data()), context.size(), 1);
  return result == 1 ? secret : std::string();
}

ByteStream::Outcome TlsStream::outcomeOf(int result) {
  switch (SSL_get_error(ssl_.get(), result)) {
    case SSL_ERROR_WANT_READ:
      return Outcome::kWantsRead;
    case SSL_ERROR_WANT_WRITE:
      return Outcome::kWantsWrite;
    case SSL_ERROR_WANT_CLIENT_HELLO_CB:
      return Outcome::kWantsApproval;
    case SSL_ERROR_ZERO_RETURN:
      return Outcome::kEnd;
    default:
      explain();
      break;
  }
  const bool alerted = ERR_GET_REASON(ERR_peek_error()) >= SSL_AD_REASON_OFFSET;
  ERR_clear_error();
  if (bio_.failed || alerted) return Outcome::kBroken;
  return bio_.ended ? Outcome::kTruncated : Outcome::kGarbage;
}

void TlsStream::explain() {
  problem_ = bio_.refused  ? "its first message is too long"
             : bio_.failed ? "the connection broke"
             : bio_.ended  ? "it closed the connection"
                           : inWords(ERR_peek_error(), ssl_.get());
}

}  // namespace naiad
