#pragma once

#include "backfill.idl.h"

namespace Rabit::Backfill
{

// The beginning of each answer: it tells which question it belongs to.
inline Answer AnswerTo(const Question &question)
{
    Answer answer;
    answer.kind = question.kind;
    answer.number = question.number;
    answer.name = question.name;
    return answer;
}

}  // namespace Rabit::Backfill
