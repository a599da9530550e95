// The fixture of tests of backends with a real network: of the suite NetworkSettings, and of one backend's
// own tests.
#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>

#include "TransportHarness.h"

namespace Rabit::Conformance
{

class NetworkFixture
{
protected:
    explicit NetworkFixture(std::unique_ptr<TransportHarness> harness) : _harness(std::move(harness)) {}
    ~NetworkFixture();  // removes what TemporaryFile made
    NetworkFixture(const NetworkFixture &) = delete;
    NetworkFixture &operator=(const NetworkFixture &) = delete;

    TransportHarness &Net() { return *_harness; }
    Transport &Backend() { return _harness->Backend(); }
    TransportSettings Settings(const std::string &node) { return _harness->SettingsFor(node, 1); }

    // Expects that a sample crosses between two sessions with these settings.
    void ExpectDelivery(const TransportSettings &one, const TransportSettings &other);
    // Expects that a session with these settings is refused in one line that contains `text`, and that the
    // refusal names the member `setting` of TransportSettings.
    void ExpectRefusal(const TransportSettings &settings, const std::string &text,
                       const std::string &setting);
    // Writes a configuration file with this text, one for each test, and returns its path.
    std::string TemporaryFile(const std::string &text);

private:
    const std::unique_ptr<TransportHarness> _harness;
    std::string _file;
};

}  // namespace Rabit::Conformance
