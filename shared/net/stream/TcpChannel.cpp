#include "shared/net/stream/TcpChannel.h"

#include <utility>

#include "shared/net/base/AddressPrefix.h"
#include "shared/net/stream/PlainStream.h"
#include "shared/net/stream/StreamConnection.h"

namespace naiad {
namespace {

class FramedChannel : public ReliableChannel {
 public:
  FramedChannel(std::unique_ptr<ByteStream> stream, std::unique_ptr<StreamFraming> framing,
                const TcpOptions& options)
      : connection_(std::make_shared<StreamConnection>(std::move(stream), std::move(framing), options)) {}
  ~FramedChannel() override { connection_->abandon(); }

  void start(Callbacks callbacks) override { connection_->start(std::move(callbacks)); }
  void send(std::string_view frame) override { connection_->send(frame); }
  std::size_t unsentBytes() const override { return connection_->unsentBytes(); }
  void close() override { connection_->close(); }
  std::string peerAddress() const override { return connection_->peer(); }
  void setReceiveLimit(std::size_t bytes) override { connection_->setReceiveLimit(bytes); }

 protected:
  std::shared_ptr<StreamConnection> connection_;
};

class TcpChannel : public FramedChannel {
 public:
  using FramedChannel::FramedChannel;

  std::string exportSecret(std::string_view label, std::string_view context,
                           std::size_t bytes) const override {
    return connection_->exportSecret(label, context, bytes);
  }
};

}  // namespace

std::unique_ptr<ReliableChannel> makeTcpChannel(asio::ip::tcp::socket socket, TcpOptions options) {
  return makeTcpChannel(std::make_unique<PlainStream>(std::move(socket)), options);
}

std::unique_ptr<ReliableChannel> makeTcpChannel(std::unique_ptr<ByteStream> stream, TcpOptions options) {
  return std::make_unique<TcpChannel>(std::move(stream),
                                      std::make_unique<LengthFraming>(options.receive_limit), options);
}

std::unique_ptr<ReliableChannel> makeFramedChannel(std::unique_ptr<ByteStream> stream,
                                                   std::unique_ptr<StreamFraming> framing,
                                                   TcpOptions options) {
  return std::make_unique<FramedChannel>(std::move(stream), std::move(framing), options);
}

bool isLoopback(const asio::ip::address& address) {
  return unmapped(address).is_loopback();
}

}  // namespace naiad
