#pragma once

#include <openssl/crypto.h>

#include <array>
#include <chrono>
#include <optional>
#include <span>

#include "envelope/Types.h"

namespace Rabit::Envelope
{

// The nonces by which this node asks others to prove that they are live. One nonce asks all nodes, since a
// request goes to all. Replace it every five seconds: an answer to the former one counts while that one is
// younger than AnswersCountFor. Time is passed in. Not thread-safe.
class OwnChallenges
{
public:
    // A recorded answer is worth nothing afterwards.
    static constexpr std::chrono::seconds AnswersCountFor{10};

    // `nonce`: random, not zero.
    void Set(const Nonce &nonce, TimePoint now)
    {
        _asked[1] = _asked[0];
        _asked[0] = {nonce, now};
    }

    // When the newest nonce was made that is among the answers: their sender lived then or later. Empty if
    // none of the answers counts.
    std::optional<TimePoint> AnsweredBy(std::span<const Nonce> answers, TimePoint now) const
    {
        for (const Asked &asked : _asked)
        {
            if (asked.Of == Nonce{} || now - asked.At > AnswersCountFor)
            {
                continue;
            }
            for (const Nonce &answer : answers)
            {
                if (CRYPTO_memcmp(answer.data(), asked.Of.data(), answer.size()) == 0)
                {
                    return asked.At;
                }
            }
        }
        return std::nullopt;
    }

private:
    struct Asked
    {
        Nonce Of{};  // zero: none
        TimePoint At{};
    };

    std::array<Asked, 2> _asked{};  // the newest first
};

}  // namespace Rabit::Envelope
