// The outcome of a message that Python sent.
#pragma once

#include <rabit/RabitQueueReceipt.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "Waitable.h"

namespace Rabit::Python
{

// The receipts of a node whose outcomes became known, for its event loop. Any thread.
class Outcomes
{
public:
    void Add(std::uint64_t number);
    std::vector<std::uint64_t> Take();
    Waitable &Ready() { return _ready; }

private:
    std::mutex _mutex;
    std::deque<std::uint64_t> _known;
    Waitable _ready;
};

class Receipt
{
public:
    Receipt(std::uint64_t number, std::string address, std::shared_ptr<Outcomes> outcomes);

    std::uint64_t Number() const { return _number; }
    const std::string &Address() const { return _address; }
    // To be given to AddMessageToQueue.
    const std::shared_ptr<RabitQueueReceipt> &Local() const { return _receipt; }
    QueueOutcome Outcome() const { return _receipt->Outcome(); }
    RabitQueueReceipt::Counts Counts() const { return _receipt->GetCounts(); }
    // Why it was refused at the call; empty if it was not.
    std::string Reason() const { return _receipt->RefusalReason(); }
    // An event loop waits: its node's Outcomes is told. True if the outcome is known already.
    bool TellLoop();
    // Needs the GIL. False after so many seconds.
    bool Wait(std::optional<double> seconds);

private:
    struct Shared
    {
        std::mutex Mutex;
        bool IsLoopTold = false;
        std::unique_ptr<Waitable> Ready;  // made by the first Wait
    };

    const std::uint64_t _number;
    const std::string _address;
    const std::shared_ptr<Outcomes> _outcomes;
    const std::shared_ptr<RabitQueueReceipt> _receipt = std::make_shared<RabitQueueReceipt>();
    const std::shared_ptr<Shared> _shared = std::make_shared<Shared>();
};

}  // namespace Rabit::Python
