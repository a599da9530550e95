// Runs the handlers of one reader (or of one session's peer events) one at a time, and stops them for good.
// All backends use it to keep the rules of Transport.h for handlers.
#pragma once

#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "common/SessionLog.h"

namespace Rabit
{

class HandlerGate
{
public:
    // `what` names the handler in the log, for instance "the reader of Pose".
    HandlerGate(std::shared_ptr<SessionLog> log, std::string what)
        : _log(std::move(log)), _what(std::move(what))
    {
    }
    HandlerGate(const HandlerGate &) = delete;
    HandlerGate &operator=(const HandlerGate &) = delete;

    // Calls `work` on this thread, after other calls have ended; does nothing once closed. Exceptions of
    // `work` are logged.
    template <typename Work>
    void Run(Work &&work) noexcept
    {
        const std::lock_guard lock(_running);
        if (!_open)
        {
            return;
        }
        try
        {
            work();
        }
        catch (const std::exception &error)
        {
            _log->HandlerThrew(_what, error.what());
        }
        catch (...)
        {
            _log->HandlerThrew(_what, "something that is not a std::exception");
        }
    }

    // Returns when no work runs any more; none starts afterwards. Must not be called from inside `work`.
    void Close()
    {
        const std::lock_guard lock(_running);
        _open = false;
    }

private:
    std::shared_ptr<SessionLog> _log;
    std::string _what;
    std::mutex _running;
    bool _open = true;
};

}  // namespace Rabit
