// What the tests of backends with a real network share, those of the suite NetworkSettings and those of one
// backend.
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

    // That a sample crosses between two sessions with these settings.
    void ExpectDelivery(const TransportSettings &one, const TransportSettings &other);
    // That a session with these settings is refused in one line, which says that, because of that member of
    // TransportSettings.
    void ExpectRefusal(const TransportSettings &settings, const std::string &text,
                       const std::string &setting);
    // A configuration file with that text. One for each test.
    std::string TemporaryFile(const std::string &text);

private:
    const std::unique_ptr<TransportHarness> _harness;
    std::string _file;
};

}  // namespace Rabit::Conformance
