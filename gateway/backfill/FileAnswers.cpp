#include "backfill/FileAnswers.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "backfill/AnswerTo.h"

namespace Rabit::Backfill
{
namespace
{

class Descriptor
{
public:
    explicit Descriptor(int number) : _number(number) {}
    ~Descriptor()
    {
        if (_number >= 0)
        {
            ::close(_number);
        }
    }
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
    int Number() const { return _number; }

private:
    const int _number;
};

bool IsPlainName(const std::string &name)
{
    return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos &&
           name.find('\0') == std::string::npos;
}

// True if open() failed with `error` since there is no such file: nothing of that name, or a link or socket.
bool IsAbsent(int error)
{
    return error == ENOENT || error == ENOTDIR || error == ELOOP || error == ENXIO || error == ENAMETOOLONG;
}

}  // namespace

std::optional<Answer> FileAnswers::Of(const std::string &node, const Question &question)
{
    Answer answer = AnswerTo(question);
    answer.from = question.from;
    answer.to = question.from;
    if (_folder.empty() || !_mayFetch(node))
    {
        answer.result = Result::NOT_ALLOWED;
        return answer;
    }
    answer.result = Result::UNKNOWN;
    if (!IsPlainName(question.name))
    {
        return answer;
    }
    const Descriptor folder(::open(_folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    // A pipe would block without O_NONBLOCK.
    const Descriptor file(folder.Number() < 0 ? -1
                                              : ::openat(folder.Number(), question.name.c_str(),
                                                         O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat status
    {
    };
    const bool isOpen = file.Number() >= 0 && ::fstat(file.Number(), &status) == 0;
    if (!isOpen && !IsAbsent(errno))
    {
        answer.result = Result::FAILED;
        return answer;
    }
    if (!isOpen || !S_ISREG(status.st_mode))
    {
        _facts.erase(question.name);
        return answer;
    }
    if (question.kind == Kind::FACTS)
    {
        return AnswerFacts(file.Number(), question, answer) ? std::optional(std::move(answer)) : std::nullopt;
    }
    const auto size = static_cast<std::uint64_t>(status.st_size);
    answer.size = size;
    answer.result = Result::FAILED;
    if (question.from > size || question.to < question.from)
    {
        return answer;
    }
    answer.bytes.resize(
        static_cast<std::size_t>(std::min({question.to - question.from, size - question.from, LargestPart})));
    std::size_t read = 0;
    while (read < answer.bytes.size())
    {
        const ssize_t part = ::pread(file.Number(), answer.bytes.data() + read, answer.bytes.size() - read,
                                     static_cast<off_t>(question.from + read));
        if (part <= 0 && !(part < 0 && errno == EINTR))
        {
            answer.bytes.clear();
            return answer;
        }
        read += part > 0 ? static_cast<std::size_t>(part) : 0;
    }
    answer.to = question.from + read;
    answer.result = Result::OK;
    return answer;
}

// A file that grows meanwhile is hashed up to the size that it had at the beginning. One that is replaced or
// cut off is hashed anew.
bool FileAnswers::AnswerFacts(int file, const Question &question, Answer &answer)
{
    struct stat status
    {
    };
    answer.result = Result::FAILED;
    if (::fstat(file, &status) != 0)
    {
        return true;
    }
    if (_facts.size() >= MostFacts && !_facts.contains(question.name))
    {
        std::erase_if(_facts, [](const auto &known) { return !known.second.Work; });
        if (_facts.size() >= MostFacts)
        {
            return false;
        }
    }
    Facts &facts = _facts[question.name];
    const auto size = static_cast<std::uint64_t>(status.st_size);
    const std::int64_t changedAt = status.st_mtim.tv_sec * 1'000'000'000 + status.st_mtim.tv_nsec;
    const bool isAnother = facts.Device != status.st_dev || facts.Inode != status.st_ino;
    const bool hasChanged = facts.Work
                                ? size < facts.Size
                                : facts.Hash.empty() || facts.Size != size || facts.ChangedAt != changedAt;
    if (isAnother || hasChanged)
    {
        facts = {size, changedAt, status.st_dev, status.st_ino, {}, std::make_unique<FileHash>(size)};
    }
    if (facts.Work)
    {
        const std::uint64_t before = facts.Work->Offset();
        const bool isReadable = facts.Work->Advance(file, _mayHash);
        _mayHash -= facts.Work->Offset() - before;
        if (isReadable && !facts.Work->IsDone())
        {
            return false;
        }
        facts.Hash = std::exchange(facts.Work, nullptr)->Take();
        if (facts.Hash.empty())
        {
            return true;
        }
    }
    answer.result = Result::OK;
    answer.size = facts.Size;
    answer.bytes = facts.Hash;
    return true;
}

}  // namespace Rabit::Backfill
