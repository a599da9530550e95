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
        answer.bytes = PostsCodec::EncodeSpans(spans);
    }
    else
    {
        AnswerPosts(question, answer);
    }
    return answer;
}

// Of an incarnation that is no longer there, nothing is there to be missed.
void PostAnswers::AnswerPosts(const Question &question, Answer &answer)
{
    const auto had = PostsCodec::DecodeStamps(question.had, question.from);
    if (!had || question.from > question.to)
    {
        answer.result = Result::FAILED;
        return;
    }
    const auto spans = _store.Spans(question.name, std::numeric_limits<std::uint64_t>::max());
    const auto span = std::find_if(spans.begin(), spans.end(),
                                   [&question](const PostsCodec::Span &one)
                                   { return one.Incarnation == question.incarnation; });
    if (span == spans.end())
    {
        return;
    }
    // Of an incarnation that is over, nothing comes behind the last post.
    const Stamp end = span->IsOver ? question.to : std::min(question.to, span->Stamps.End);
    const Range range{question.from, std::max(question.from, end)};
    PostStore::Found found = _store.Read(question.name, question.incarnation, range, *had, LargestAnswer);
    answer.result = found.IsReadable ? Result::OK : Result::FAILED;
    answer.from = found.First;
    answer.to = range.End;
    answer.bytes = PostsCodec::EncodePosts(found.Posts, found.First);
}

}  // namespace Rabit::Backfill
