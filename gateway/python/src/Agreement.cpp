#include "Agreement.h"

#include <utility>

namespace Rabit::Python
{

ClaimWait::ClaimWait(const Claims &claims, std::string claim, Until until)
    : _claims(claims),
      _claim(std::move(claim)),
      _until(until),
      _connection(_claims.ConnectChanged(RabitQuickHandler([ready = _ready] { ready->Notify(); })))
{
}

bool ClaimWait::IsReady() const
{
    if (_isClosed)
    {
        return true;
    }
    const Claims::Status status = _claims.StatusOf(_claim);
    return _until == Until::Lost ? !status.Fence : status.Fence || !status.IsWanted;
}

void ClaimWait::Close()
{
    _isClosed = true;
    _ready->Close();
}

Agreement::Agreement(GatewayConfig &config) : _claims(config), _table(config) {}

bool Agreement::Acquire(const std::string &claim, bool once)
{
    return once ? _claims.Try(claim) : _claims.Claim(claim);
}

void Agreement::Release(const std::string &claim)
{
    if (IsForked())
    {
        return;
    }
    _claims.Release(claim);
    // A release is no change that Claims tell.
    std::vector<std::shared_ptr<ClaimWait>> waits;
    {
        const std::lock_guard lock(_mutex);
        waits = Waits();
    }
    for (const auto &wait : waits)
    {
        wait->Ready().Notify();
    }
}

std::shared_ptr<ClaimWait> Agreement::Wait(const std::string &claim, ClaimWait::Until until)
{
    auto wait = std::make_shared<ClaimWait>(_claims, claim, until);
    const std::lock_guard lock(_mutex);
    std::erase_if(_waits, [](const auto &weak) { return weak.expired(); });
    _waits.push_back(wait);
    if (_isClosed)
    {
        wait->Close();
    }
    return wait;
}

Claims::Status Agreement::StatusOf(const std::string &claim) const
{
    return IsForked() ? Claims::Status() : _claims.StatusOf(claim);
}

std::vector<std::string> Agreement::Mine() const
{
    return IsForked() ? std::vector<std::string>() : _claims.Mine();
}

void Agreement::ConnectChanged(const RabitHandler &handler)
{
    _claims.ConnectChanged(handler);
    _table.ConnectChanged(handler);
}

void Agreement::Close()
{
    std::vector<std::shared_ptr<ClaimWait>> waits;
    {
        const std::lock_guard lock(_mutex);
        _isClosed = true;
        waits = Waits();
    }
    for (const auto &wait : waits)
    {
        wait->Close();
    }
}

std::vector<std::shared_ptr<ClaimWait>> Agreement::Waits()
{
    std::vector<std::shared_ptr<ClaimWait>> waits;
    for (const auto &weak : _waits)
    {
        if (auto wait = weak.lock())
        {
            waits.push_back(std::move(wait));
        }
    }
    return waits;
}

}  // namespace Rabit::Python
