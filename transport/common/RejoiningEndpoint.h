#pragma once

#include <rabit/transport/Transport.h>

namespace Rabit
{

// A writer or reader that can be made anew in another session of the backend.
class RejoiningEndpoint
{
public:
    virtual void Open(TransportSession &session) = 0;
    virtual void Close() = 0;

protected:
    ~RejoiningEndpoint() = default;
};

}  // namespace Rabit
