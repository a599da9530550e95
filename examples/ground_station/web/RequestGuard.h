#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace Ground
{

// Allows only the server's own pages to talk to it. A page of another site in the same browser reaches
// every port that the browser reaches; it must not command aircraft.
//
// - The Host of every request must be a name that no attacker can point here: a numerical address or
//   `localhost`, or a name of this machine or of its certificate. A site that points a name of its own at
//   this machine (DNS rebinding) shows that name. A server that is bound to the loopback interface takes
//   loopback names only.
// - The Origin of a WebSocket must equal the Host, with https where the server speaks TLS.
//
// Immutable: any thread.
class RequestGuard
{
public:
    RequestGuard(bool boundToLoopback, std::vector<std::string> names, bool hasTls = false);

    bool IsHostAllowed(std::string_view host) const;
    // The host must have passed IsHostAllowed.
    bool IsOriginAllowed(std::string_view origin, std::string_view host) const;

private:
    const bool _loopback;
    const std::vector<std::string> _names;
    const bool _hasTls;
};

}  // namespace Ground
