#include "WorkspaceForwarders.h"

#include <rabit/RabitQueueReceipt.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

namespace Rabit
{
namespace
{

// Holds a receipt, which may be null, for as long as it lives.
class ReceiptHold
{
public:
    explicit ReceiptHold(const std::shared_ptr<RabitQueueReceipt> &receipt) : _receipt(receipt)
    {
        if (_receipt)
        {
            _receipt->Hold();
        }
    }
    ~ReceiptHold()
    {
        if (_receipt)
        {
            _receipt->Release();
        }
    }
    ReceiptHold(const ReceiptHold &) = delete;
    ReceiptHold &operator=(const ReceiptHold &) = delete;

private:
    const std::shared_ptr<RabitQueueReceipt> _receipt;
};

}  // namespace

// A snapshot of the forwarders, which count as in use while it lives.
class WorkspaceForwarders::Calls
{
public:
    explicit Calls(WorkspaceForwarders &forwarders) : _forwarders(forwarders)
    {
        const std::lock_guard<std::mutex> lock(_forwarders._mutex);
        _slots = _forwarders._slots;
        for (const auto &slot : *_slots)
        {
            ++slot->CallsInProgress;
        }
    }
    ~Calls()
    {
        const std::lock_guard<std::mutex> lock(_forwarders._mutex);
        for (const auto &slot : *_slots)
        {
            --slot->CallsInProgress;
        }
        _forwarders._idle.notify_all();
    }
    Calls(const Calls &) = delete;
    Calls &operator=(const Calls &) = delete;

    const Slots &All() const { return *_slots; }

private:
    WorkspaceForwarders &_forwarders;
    std::shared_ptr<const Slots> _slots;
};

bool WorkspaceForwarders::Add(const std::string &name, std::shared_ptr<QueueForwarder> forwarder)
{
    if (!forwarder)
    {
        throw std::invalid_argument("a null queue forwarder cannot be added as \"" + name + "\"");
    }
    const auto slot = std::make_shared<Slot>(Slot{name, std::move(forwarder)});
    const std::lock_guard<std::mutex> lock(_mutex);
    if (std::any_of(_slots->begin(), _slots->end(), [&name](const auto &one) { return one->Name == name; }))
    {
        return false;
    }
    auto slots = std::make_shared<Slots>(*_slots);
    slots->push_back(slot);
    _slots = std::move(slots);
    return true;
}

void WorkspaceForwarders::Replace(const std::string &name, std::shared_ptr<QueueForwarder> forwarder)
{
    // Both outlive the lock, so that a forwarder is destroyed outside of it.
    std::shared_ptr<Slot> former;
    std::shared_ptr<const Slots> before;
    auto slots = std::make_shared<Slots>();
    std::unique_lock<std::mutex> lock(_mutex);
    before = _slots;
    for (const auto &slot : *before)
    {
        if (slot->Name != name)
        {
            slots->push_back(slot);
            continue;
        }
        former = slot;
        if (forwarder)
        {
            slots->push_back(std::make_shared<Slot>(Slot{name, std::move(forwarder)}));
        }
    }
    if (!former && forwarder)
    {
        slots->push_back(std::make_shared<Slot>(Slot{name, std::move(forwarder)}));
    }
    _slots = std::move(slots);
    if (former)
    {
        _idle.wait(lock, [&former] { return former->CallsInProgress == 0; });
    }
}

std::vector<std::string> WorkspaceForwarders::Names() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    std::vector<std::string> names;
    for (const auto &slot : *_slots)
    {
        names.push_back(slot->Name);
    }
    return names;
}

std::optional<bool> WorkspaceForwarders::Forward(const std::string &name,
                                                 const std::shared_ptr<RabitMessage> &message,
                                                 const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    if (!message)
    {
        return std::nullopt;
    }
    const Calls calls(*this);
    if (calls.All().size() == 1)  // the usual case: no choice, and no allocation
    {
        QueueForwarder &only = *calls.All().front()->Forwarder;
        return only.Handles(name) ? std::optional<bool>(only.Forward(name, message, receipt)) : std::nullopt;
    }
    std::vector<QueueForwarder *> handling;
    for (const auto &slot : calls.All())
    {
        if (slot->Forwarder->Handles(name))
        {
            handling.push_back(slot->Forwarder.get());
        }
    }
    if (handling.empty())
    {
        return std::nullopt;
    }
    return handling.size() == 1 ? handling.front()->Forward(name, message, receipt)
                                : ForwardAmong(handling, name, message, receipt);
}

bool WorkspaceForwarders::ForwardAmong(const std::vector<QueueForwarder *> &forwarders,
                                       const std::string &name, const std::shared_ptr<RabitMessage> &message,
                                       const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    std::vector<std::pair<QueueForwarder *, std::string>> deliveries;
    std::set<std::string> taken;
    std::set<QueueForwarder *> taking;
    for (QueueForwarder *forwarder : forwarders)
    {
        for (std::string &queue : forwarder->Known(name, *message))
        {
            if (taken.insert(queue).second)
            {
                taking.insert(forwarder);
                deliveries.emplace_back(forwarder, std::move(queue));
            }
        }
    }
    if (deliveries.empty())
    {
        return forwarders.front()->Forward(name, message, receipt);
    }
    for (QueueForwarder *forwarder : forwarders)
    {
        if (taking.count(forwarder) == 0 || taking.size() > 1)
        {
            forwarder->TakenElsewhere(name);
        }
    }
    if (taking.size() == 1)  // it knows all known queues of the name
    {
        return (*taking.begin())->Forward(name, message, receipt);
    }
    const ReceiptHold hold(receipt);
    bool all = true;
    for (const auto &[forwarder, queue] : deliveries)
    {
        all = forwarder->Forward(queue, message, receipt) && all;
    }
    return all;
}

}  // namespace Rabit
