#include "backfill/PostAnswers.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "backfill/AnswerTo.h"

namespace Rabit::Backfill
{

Answer PostAnswers::Of(const std::string &node, const Question &question)
{
    Answer answer = AnswerTo(question);
    answer.incarnation = question.incarnation;
    answer.from = question.from;
    answer.to = question.to;
    if (!_mayHave(node, question.name))
    {
        answer.result = Result::NOT_ALLOWED;
    }
    else if (!_offers(question.name))
    {
        answer.result = Result::UNKNOWN;
    }
    else if (question.kind == Kind::SPANS)
    {
        const auto spans = _store.Spans(question.name, question.to);
        answer.result = spans ? Result::OK : Result::FAILED;
        answer.bytes = PostsCodec::EncodeSpans(spans.value_or(std::vector<PostsCodec::Span>()));
    }
    else
    {
        AnswerPosts(question, answer);
    }
    return answer;
}

// A node asks only for stamps within a span that it was told once. So posts before the present span, and
// those of a former incarnation without one, were removed. The present one may not have written its first
// ones yet.
void PostAnswers::AnswerPosts(const Question &question, Answer &answer)
{
    const auto had = PostsCodec::DecodeStamps(question.had, question.from);
    // As long as it is not known which incarnation is the present one, nothing can be said to be over.
    if (!had || question.from > question.to || _store.Present() == 0)
    {
        answer.result = Result::FAILED;
        return;
    }
    const std::size_t most = question.most == 0
                                 ? LargestAnswer
                                 : std::clamp<std::size_t>(question.most, SmallestAnswer, LargestAnswer);
    if (question.offset > 0 && _large.Name == question.name && _large.Incarnation == question.incarnation &&
        _large.Of == question.from)
    {
        AnswerPart(question, most, answer);
        return;
    }
    const auto spans = _store.Spans(question.name, std::numeric_limits<std::uint64_t>::max());
    if (!spans)
    {
        answer.result = Result::FAILED;
        return;
    }
    const auto span = std::find_if(spans->begin(), spans->end(),
                                   [&question](const PostsCodec::Span &one)
                                   { return one.Incarnation == question.incarnation; });
    const bool isThere = span != spans->end();
    if (!isThere && question.incarnation == _store.Present())
    {
        answer.to = question.from;
        return;
    }
    if (!isThere || (question.from < question.to && span->Stamps.First >= question.to))
    {
        answer.result = Result::FAILED;
        answer.size = NeverReadable;
        return;
    }
    // Of an incarnation that is over, nothing comes behind the last post.
    const Stamp end = span->IsOver ? question.to : std::min(question.to, span->Stamps.End);
    const Stamp first = std::max(question.from, std::min(question.to, span->Stamps.First));
    const Range range{first, std::max(first, end)};
    PostStore::Found found = _store.Read(question.name, question.incarnation, range, *had, most);
    answer.result = found.Is == PostStore::Found::Result::Readable ? Result::OK : Result::FAILED;
    answer.size = found.Is == PostStore::Found::Result::Damaged ? NeverReadable : 0;
    answer.from = found.First;
    answer.to = range.End;
    if (found.Posts.size() == 1 && (found.Posts.front().Bytes.size() > most || question.offset > 0))
    {
        const Stamp stamp = StampOf(found.Posts.front().SourceTime);
        _large = {question.name, question.incarnation, stamp, PostsCodec::EncodePosts(found.Posts, stamp)};
        AnswerPart(question, most, answer);
        return;
    }
    answer.bytes = PostsCodec::EncodePosts(found.Posts, found.First);
}

// Each part is cut from the same bytes, whatever was asked before. After the last one they are given up.
void PostAnswers::AnswerPart(const Question &question, std::size_t most, Answer &answer)
{
    answer.from = _large.Of;
    answer.size = _large.Bytes.size();
    answer.offset = std::min<std::uint64_t>(question.offset, _large.Bytes.size());
    const auto begin = _large.Bytes.begin() + static_cast<std::ptrdiff_t>(answer.offset);
    const auto left = static_cast<std::size_t>(_large.Bytes.end() - begin);
    answer.bytes.assign(begin, begin + static_cast<std::ptrdiff_t>(std::min(most, left)));
    if (left <= most)
    {
        _large = {};
    }
}

}  // namespace Rabit::Backfill
