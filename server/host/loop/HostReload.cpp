// A host whose options change while it runs.
#include <asio/post.hpp>
#include <utility>

#include "host/loop/Host.h"
#include "shared/program/LogText.h"

namespace naiad {

void Host::reload(Reloading done) {
  if (!m_reload) return done(false, "this server cannot read its options again");
  const bool began = m_reload->begin(m_options, [this, done](Reloaded reloaded) {
    asio::post(m_io, [this, done, reloaded = std::make_shared<Reloaded>(std::move(reloaded))] {
      adoptReloaded(std::move(*reloaded), done);
    });
  });
  if (!began) done(false, "the options are being read already");
}

void Host::adoptReloaded(Reloaded reloaded, const Reloading& done) {
  if (!reloaded.problem.empty()) return done(false, "the options stay as they were: " + reloaded.problem);
  if (reloaded.options.password != m_options.password)
    m_admission.changePassword(std::move(reloaded.password));
  const OptionChanges changes = takeOver(reloaded.options, m_options);
  makePlaces();
  useIdentity(std::move(reloaded.identity));
  done(true, "the options were read again: " + changes.text());
}

void Host::useIdentity(std::optional<ServerIdentity> identity) {
  if (!identity) return;
  if (identity->fingerprint() != m_identity->fingerprint()) {
    m_log(LogEvent::warning("the key is another one: players who know the server are warned of it. It is " +
                            identity->fingerprint().text()));
  }
  m_identity = std::move(identity);
  m_network.setTls(m_identity->tls());
}

}  // namespace naiad
