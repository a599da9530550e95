#include "Receipt.h"

namespace Rabit::Python
{

void Outcomes::Add(std::uint64_t number)
{
    {
        const std::lock_guard lock(_mutex);
        _known.push_back(number);
    }
    _ready.Notify();
}

std::vector<std::uint64_t> Outcomes::Take()
{
    const std::lock_guard lock(_mutex);
    std::vector<std::uint64_t> known(_known.begin(), _known.end());
    _known.clear();
    return known;
}

Receipt::Receipt(std::uint64_t number, std::string address, std::shared_ptr<Outcomes> outcomes)
    : _number(number), _address(std::move(address)), _outcomes(std::move(outcomes))
{
    _receipt->ConnectOutcomeKnown(RabitQuickHandler(
        [shared = _shared, told = _outcomes, number = _number]
        {
            const std::lock_guard lock(shared->Mutex);
            if (shared->IsLoopTold)
            {
                told->Add(number);
            }
            if (shared->Ready)
            {
                shared->Ready->Notify();
            }
        }));
}

bool Receipt::TellLoop()
{
    {
        const std::lock_guard lock(_shared->Mutex);
        _shared->IsLoopTold = true;
    }
    return Outcome() != QueueOutcome::Pending;
}

bool Receipt::Wait(std::optional<double> seconds)
{
    if (Outcome() != QueueOutcome::Pending)
    {
        return true;
    }
    {
        const std::lock_guard lock(_shared->Mutex);
        if (!_shared->Ready)
        {
            _shared->Ready = std::make_unique<Waitable>();
        }
    }
    return _shared->Ready->Wait(seconds, [this] { return Outcome() != QueueOutcome::Pending; });
}

}  // namespace Rabit::Python
