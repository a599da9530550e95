#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "common/SendingTurn.h"
#include "envelope/MergedMessage.h"

namespace Rabit::Rtps
{

// The RTPS messages that go one way in a turn, as one.
class MergedDatagram final : public TurnDatagram
{
public:
    // most: as MergedMessage. send: sends the message, which it may change.
    MergedDatagram(std::size_t most, std::function<void(std::vector<std::uint8_t> &message)> send)
        : _message(most), _send(std::move(send))
    {
    }

    std::size_t Add(std::span<const std::uint8_t> datagram) override { return _message.Add(datagram); }
    void Send() override { _send(_message.Bytes()); }

private:
    MergedMessage _message;
    const std::function<void(std::vector<std::uint8_t> &message)> _send;
};

}  // namespace Rabit::Rtps
