#pragma once

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "envelope/Claim.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// The nonces of others that this node's next claim answers. Claims may be recordings, which ask again and
// again: so one claim answers many nonces, and claims have a distance. Time is passed in. Not thread-safe.
class OwnAnswers
{
public:
    // Between two claims of at most a kilobyte each: 5 kB/s. Shorter than what a node that comes notices.
    static constexpr std::chrono::milliseconds Spacing{200};

    // The nonce of a claim (Opener::Result::Challenge) has to be answered; zero: none. `verified`: the claim
    // was opened without a fault. Budgets bound how many are. Of the others, the newest ones are kept.
    void Ask(const Nonce &nonce, bool verified)
    {
        if (nonce != Nonce{})
        {
            Add(nonce, verified ? _verified : _others);
        }
    }

    // Returns the nonces that a claim to all should answer now, those of verified claims first. Empty: there
    // is none, or the last claim was sent too recently. Forgets all nonces otherwise: their senders ask
    // again.
    std::vector<Nonce> Take(TimePoint now)
    {
        if (now < _next || (_verified.empty() && _others.empty()))
        {
            return {};
        }
        _next = now + Spacing;
        std::vector<Nonce> taken = std::exchange(_verified, {});
        for (const Nonce &nonce : std::exchange(_others, {}))
        {
            if (taken.size() < Claim::MostAnswers)
            {
                Add(nonce, taken);
            }
        }
        return taken;
    }

private:
    static void Add(const Nonce &nonce, std::vector<Nonce> &to)
    {
        if (std::find(to.begin(), to.end(), nonce) != to.end())
        {
            return;
        }
        if (to.size() == Claim::MostAnswers)
        {
            to.erase(to.begin());
        }
        to.push_back(nonce);
    }

    std::vector<Nonce> _verified;  // the oldest first
    std::vector<Nonce> _others;
    TimePoint _next{};
};

}  // namespace Rabit::Envelope
