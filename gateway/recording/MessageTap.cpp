#include "recording/MessageTap.h"

#include <utility>

namespace Rabit
{

MessageTap::MessageTap(std::shared_ptr<PublishSubscribeMessage> global,
                       std::shared_ptr<RecordingTarget> target, std::uint32_t stream, Encode encode,
                       std::string event)
    : _global(std::move(global)),
      _target(std::move(target)),
      _stream(stream),
      _encode(std::move(encode)),
      _event(std::move(event))
{
}

MessageTap::~MessageTap() = default;

void MessageTap::Begin()
{
    const std::lock_guard lock(_mutex);
    // Connected first, so that no post comes between the copy and the handler.
    _connection = RabitScopedConnection(_global->ConnectSomethingPublished(RabitQuickHandler(
        [weak = weak_from_this()]
        {
            if (const auto tap = weak.lock())
            {
                tap->OnPost();
            }
        })));
    // Ends soon: whoever posts now waits in the handler for the lock.
    do
    {
        _seen = _global->GetNumberOfPosts();
        _copy = _global->GetCopyOfMessage();
    } while (_seen != _global->GetNumberOfPosts());
    if (_copy->WasPosted())
    {
        Record();
    }
}

void MessageTap::OnPost()
{
    const std::lock_guard lock(_mutex);
    std::uint64_t recorded = 0;
    std::uint64_t posts = 0;
    do  // as in Begin
    {
        posts = _global->GetNumberOfPosts();
        if (_global->FetchMessage(_copy.get()))
        {
            Record();
            ++recorded;
        }
    } while (posts != _global->GetNumberOfPosts());
    if (posts > _seen + recorded)
    {
        _target->Inbox().AddLost(_stream, posts - _seen - recorded);
    }
    _seen = posts;
}

void MessageTap::Record()
{
    Mcap::Bytes bytes;
    if (_encode(*_copy, bytes))
    {
        _target->Put(_stream, _target->At(_copy->GetPostTime().Monotonic), std::move(bytes));
    }
    else
    {
        _target->Inbox().AddLost(_stream, 1);
    }
    if (!_event.empty())
    {
        _target->Happened(_event);
    }
}

}  // namespace Rabit
