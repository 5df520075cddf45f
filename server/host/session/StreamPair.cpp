#include "host/session/StreamPair.h"

#include <utility>

namespace naiad {

StreamPair::StreamPair(std::unique_ptr<ReliableChannel> first) : m_first(std::move(first)) {
  m_route->pair = this;
}

void StreamPair::start(Callbacks callbacks, std::size_t limit) {
  m_callbacks = std::move(callbacks);
  m_first->setReceiveLimit(limit);
  m_first->start({[to = m_route](std::string_view frame) {
                    const Callbacks& here = to->pair->m_callbacks;
                    to->second ? here.on_second_frame(frame) : here.on_frame(frame);
                  },
                  [to = m_route](CloseReason reason) {
                    const Callbacks& here = to->pair->m_callbacks;
                    to->second ? here.on_second_closed(reason) : here.on_closed(reason);
                  }});
}

void StreamPair::adoptFirst(StreamPair& other) {
  dropSecond();
  if (m_first != nullptr) {  // the client has left it, but the server has not noticed yet
    std::swap(m_route, other.m_route);
    std::swap(m_first, other.m_first);
  } else {
    m_route = std::exchange(other.m_route, std::make_shared<Route>());
    m_first = std::move(other.m_first);
  }
  m_route->pair = this;
  other.m_route->pair = &other;
  m_stall.restart();
}

void StreamPair::adoptAsSecond(StreamPair& other, std::size_t limit) {
  dropSecond();
  m_second = std::move(other.m_first);
  const auto route = std::exchange(other.m_route, std::make_shared<Route>());
  route->pair = this;
  route->second = true;
  other.m_route->pair = &other;
  m_second->setReceiveLimit(limit);
}

void StreamPair::dropSecond() {
  if (m_second == nullptr) return;
  m_second->close();
  m_second.reset();
}

void StreamPair::detach() {
  m_address = m_first->peerAddress();
  m_first.reset();
  dropSecond();
}

void StreamPair::close() {
  dropSecond();
  if (m_first != nullptr) m_first->close();
}

void StreamPair::sendFirst(std::string_view frame) {
  if (m_first != nullptr) m_first->send(frame);
}

void StreamPair::sendSecond(std::string_view frame) {
  if (m_second != nullptr) m_second->send(frame);
}

}  // namespace naiad
