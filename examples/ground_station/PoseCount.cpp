#include "PoseCount.h"

namespace Ground
{

void PoseCount::OnPose(std::uint32_t number)
{
    if (number < _newest)
        StartNewLife();  // poses of one incarnation never overtake each other
    if (number == 0 || number == _newest)
        return;  // not numbered, or a repetition
    if (_first == 0)
        _first = number;
    _newest = number;
    if (_open && number <= _end)
    {
        if (number > _begin)
            ++_heard;
        return;
    }
    _waiting.push_back(number);
    if (_waiting.size() > MaxWaiting)
        _waiting.pop_front();
}

void PoseCount::OnMissionState(std::uint32_t poses)
{
    if (_open && poses < _end)
        StartNewLife();
    if (!_open)
    {
        if (_first == 0 || poses < _first)
            return;  // older than the first pose heard
        _open = true;
        _begin = poses;
        while (!_waiting.empty() && _waiting.front() <= poses)
            _waiting.pop_front();
    }
    _end = poses;
    while (!_waiting.empty() && _waiting.front() <= poses)
    {
        ++_heard;
        _waiting.pop_front();
    }
}

void PoseCount::StartNewLife()
{
    _earlierPublished = Published();
    _earlierHeard = Heard();
    _open = false;
    _first = _newest = _begin = _end = 0;
    _heard = 0;
    _waiting.clear();
}

}  // namespace Ground
