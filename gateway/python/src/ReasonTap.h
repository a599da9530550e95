// Remembers why a message was refused at the call.
#pragma once

#include <rabit/gateway/GatewayTap.h>

#include <memory>
#include <string>

namespace Rabit::Python
{

// Passes all on to another tap, which may be null.
class ReasonTap final : public GatewayTap
{
public:
    explicit ReasonTap(std::shared_ptr<GatewayTap> inner) : _inner(std::move(inner)) {}

    // The last reason on this thread.
    static std::string &Last()
    {
        thread_local std::string reason;
        return reason;
    }

    void Sent(const QueueMessage &message) override
    {
        if (_inner)
        {
            _inner->Sent(message);
        }
    }
    void Refused(const QueueMessage &message, std::string_view reason) override
    {
        Last() = reason;
        if (_inner)
        {
            _inner->Refused(message, reason);
        }
    }
    void Settled(std::string_view node, std::string_view queue, std::uint64_t id,
                 QueueOutcome outcome) override
    {
        if (_inner)
        {
            _inner->Settled(node, queue, id, outcome);
        }
    }
    void Received(const QueueMessage &message) override
    {
        if (_inner)
        {
            _inner->Received(message);
        }
    }
    void Mirrored(const MirroredSample &sample) override
    {
        if (_inner)
        {
            _inner->Mirrored(sample);
        }
    }
    void Clocks(std::uint64_t incarnation, std::chrono::nanoseconds sourceAhead,
                const std::vector<PeerClock> &peers) override
    {
        if (_inner)
        {
            _inner->Clocks(incarnation, sourceAhead, peers);
        }
    }
    std::vector<Gateway::Problem> Problems() override
    {
        return _inner ? _inner->Problems() : std::vector<Gateway::Problem>();
    }

private:
    const std::shared_ptr<GatewayTap> _inner;
};

}  // namespace Rabit::Python
