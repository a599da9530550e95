#pragma once

#include <atomic>

namespace Rabit
{

// How much a session's discovery may say (TransportSession::SetDiscoveryRate), for whichever of the vendor's
// sessions there is now. Thread-safe.
class DiscoveryRate
{
public:
    void Set(double bytesPerSecond) { _bytesPerSecond = bytesPerSecond; }
    double Get() const { return _bytesPerSecond; }

private:
    std::atomic<double> _bytesPerSecond{0.0};
};

}  // namespace Rabit
