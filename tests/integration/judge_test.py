#!/usr/bin/env python3
"""The judge finds each way in which ledgers can be wrong, and has nothing against those that are right."""

import unittest

import judge

S = 1_000_000_000


def sender(lines, end=True, node="a", life=10):
    return "\n".join([f"{life} start node={node} life={life} room=5", *lines] + (["99000000000 end"] if end else [])) \
        + "\n"


def sent(number, at=1, expire=0, life_to="b", kind="accepted"):
    return [f"{at * S} intent to={life_to} id={number} expire_s={expire}", f"{at * S + 1} {kind} to={life_to} id={number}"]


def counters(accepted, delivered, expired=0, in_doubt=0):
    return [f"{98 * S} link to=b accepted={accepted} delivered={delivered} expired={expired} in_doubt={in_doubt} "
            "undeliverable=0 outbox=0 resent=0"]


def told(*outcomes):
    return [f"{97 * S} outcome to=b id={number} is=\"{outcome}\"" for number, outcome in enumerate(outcomes, 1)]


def pictured(number):
    return [f"1000000000 picture_intent to=b id={number} expire_s=0", f"1000000001 picture_sent to=b id={number}",
            f"2000000000 picture_outcome to=b id={number} is=\"delivered\""]


def picture_counters(count):
    return [f"{98 * S} link to=b queue=Pictures accepted={count} delivered={count} expired=0 in_doubt=0 undeliverable=0 "
            "outbox=0 resent=0"]


def got(number, at=2, life=10, extra=""):
    return f"{at * S} delivered from=a life={life} id={number}{extra}"


def receiver(lines, end=True, life=11):
    return sender(lines, end, "b", life)


THREE = sent(1) + sent(2) + sent(3)
ALL_DELIVERED = told("delivered", "delivered", "delivered")


class JudgeTest(unittest.TestCase):
    def right(self, *ledgers):
        self.assertEqual(judge.judge(ledgers), [])

    def wrong(self, word, *ledgers):
        found = judge.judge(ledgers)
        self.assertTrue(any(word in text for text in found), f"{word!r} not in {found}")

    def test_accepts_complete_ledgers(self):
        self.right(sender(THREE + ALL_DELIVERED + counters(3, 3)), receiver([got(1), got(2), got(3)]))

    def test_finds_a_loss_in_the_middle(self):
        self.wrong("lost, from 2 to 2", sender(THREE + counters(3, 3)), receiver([got(1), got(3)]))

    def test_finds_a_loss_at_the_end(self):
        self.wrong("lost, from 3 to 3", sender(THREE + counters(3, 3)), receiver([got(1), got(2)]))

    def test_finds_that_nothing_arrived(self):
        self.wrong("lost, from 1 to 3", sender(THREE + counters(3, 3)), receiver([]))

    def test_finds_a_duplicate(self):
        self.wrong("duplicate", sender(THREE + counters(3, 3)), receiver([got(1), got(2), got(2), got(3)]))

    def test_finds_a_duplicate_in_the_next_life(self):
        self.wrong("duplicate", sender(THREE + counters(3, 3)),
                   receiver([got(1), got(2)], end=False) + receiver([got(2), got(3)], life=12))

    def test_accepts_a_flagged_duplicate(self):
        self.right(sender(THREE + ALL_DELIVERED + counters(3, 3)),
                   receiver([got(1), got(2), got(2, extra=" redelivered=1"), got(3)]))

    def test_finds_a_wrong_order(self):
        self.wrong("out of order", sender(THREE + counters(3, 3)), receiver([got(1), got(3), got(2)]))

    def test_finds_a_note_of_an_older_life_after_a_newer_one(self):
        self.wrong("out of order",
                   sender(sent(1), end=False) + sender(sent(1) + counters(1, 1), life=20),
                   receiver([got(1, life=20), got(1, life=10)]))

    def test_finds_a_phantom(self):
        self.wrong("phantom", sender(THREE + counters(3, 3)), receiver([got(1), got(2), got(3), got(4)]))

    def test_finds_a_refused_note_that_arrived(self):
        self.wrong("refused and yet", sender(sent(1) + sent(2, kind="refused") + counters(1, 1)),
                   receiver([got(1), got(2)]))

    def test_accepts_an_expired_note_that_is_said_to_be(self):
        self.right(sender(sent(1, expire=5) + sent(2, expire=5) + told("expired", "delivered") +
                          counters(2, 1, expired=1)), receiver([got(2)]))

    def test_finds_a_note_said_to_be_expired_that_arrived(self):
        self.wrong("said to be expired", sender(sent(1, expire=5) + counters(1, 0, expired=1)), receiver([got(1)]))

    def test_finds_a_lost_note_said_to_be_delivered(self):
        self.wrong("said to be delivered", sender(sent(1, expire=5) + counters(1, 1)), receiver([]))

    def test_finds_an_expiry_of_what_cannot_expire(self):
        self.wrong("cannot expire", sender(sent(1) + counters(1, 0, expired=1)), receiver([]))

    def test_finds_an_outcome_that_was_never_told(self):
        self.wrong("outcomes of 2 told", sender(THREE + counters(3, 2)), receiver([got(1), got(2), got(3)]))

    def test_finds_that_no_outcomes_were_told(self):
        self.wrong("no outcomes told", sender(THREE), receiver([got(1), got(2), got(3)]))

    def test_finds_doubt_without_a_kill(self):
        self.wrong("though the receiver never ended", sender(THREE + counters(3, 2, in_doubt=1)),
                   receiver([got(1), got(2), got(3)]))

    def test_accepts_doubt_where_the_receiver_was_stopped_and_started_again(self):
        self.right(sender(THREE + told("delivered", "in doubt", "delivered") + counters(3, 2, in_doubt=1)),
                   receiver([got(1)]) + receiver([got(3)], life=12))

    def test_asks_nothing_about_the_last_note_of_a_sender_that_was_stopped_at_work_and_came_back(self):
        self.right(sender(THREE + told("delivered", "delivered") + counters(2, 2)) + sender([], life=20),
                   receiver([got(1), got(2)]))

    def test_finds_a_loss_in_the_row_of_a_sender_that_was_stopped_at_work_and_came_back(self):
        self.wrong("lost, from 2 to 2", sender(THREE) + sender([], life=20), receiver([got(1), got(3)]))

    def test_finds_a_loss_after_the_last_stop_of_the_receiver(self):
        self.wrong("lost, from 3 to 3", sender(THREE + counters(3, 3)),
                   receiver([got(1)]) + receiver([got(2)], life=12))

    def test_finds_accepted_notes_that_the_gateway_did_not_count(self):
        self.wrong("the gateway counted 2", sender(THREE + counters(2, 2)), receiver([got(1), got(2), got(3)]))

    def test_finds_a_note_told_to_be_delivered_that_never_arrived(self):
        self.wrong("note 3 was told to be delivered and never", sender(THREE + ALL_DELIVERED + counters(3, 3)),
                   receiver([got(1), got(2)]))

    def test_finds_a_note_told_to_be_expired_that_arrived(self):
        self.wrong("note 2 was told to be expired and arrived",
                   sender(THREE + told("delivered", "expired", "delivered") + counters(3, 3)),
                   receiver([got(1), got(2), got(3)]))

    def test_finds_a_note_told_to_be_refused_that_arrived(self):
        self.wrong("note 1 was told to be refused and arrived",
                   sender(THREE + told("refused", "delivered", "delivered") + counters(3, 3)),
                   receiver([got(1), got(2), got(3)]))

    def test_finds_a_note_told_to_be_in_doubt_without_a_kill(self):
        self.wrong("note 2 was told to be in doubt", sender(THREE + told("delivered", "in doubt", "delivered")),
                   receiver([got(1), got(2), got(3)]))

    def test_accepts_doubt_about_a_note_whose_time_is_over(self):
        notes = sent(1, 1, 5) + sent(2, 2, 5) + sent(3, 3, 5)
        outcomes = [f"{3 * S} outcome to=b id=1 is=delivered", f"{13 * S} outcome to=b id=2 is=\"in doubt\"",
                    f"{13 * S} outcome to=b id=3 is=\"in doubt\""]
        self.right(sender(notes + outcomes + counters(3, 1, in_doubt=2)), receiver([got(1), got(2)]))

    def test_finds_doubt_about_a_note_that_has_time_left(self):
        notes = sent(1, 1, 60) + sent(2, 2, 60)
        outcomes = [f"{3 * S} outcome to=b id=1 is=delivered", f"{23 * S} outcome to=b id=2 is=\"in doubt\""]
        self.wrong("note 2 was told to be in doubt", sender(notes + outcomes + counters(2, 1, in_doubt=1)),
                   receiver([got(1)]))

    def test_finds_a_note_of_which_nothing_was_told(self):
        self.wrong("nothing was told of 1 accepted notes, the first of them 3",
                   sender(THREE + told("delivered", "delivered") + counters(3, 3)),
                   receiver([got(1), got(2), got(3)]))

    def test_finds_two_outcomes_of_one_note(self):
        self.wrong("note 1 has two outcomes", sender(THREE + ALL_DELIVERED + told("delivered")),
                   receiver([got(1), got(2), got(3)]))

    def test_finds_an_outcome_of_a_note_that_was_not_accepted(self):
        self.wrong("outcome of note 2, which was not accepted",
                   sender(sent(1) + sent(2, kind="refused") + told("delivered", "delivered") + counters(1, 1)),
                   receiver([got(1)]))

    def test_finds_a_garbled_note(self):
        self.wrong("garbled", sender(THREE + counters(3, 3)),
                   receiver([got(1), got(2), got(3), f"{3 * S} garbled"]))

    def test_accepts_what_a_kill_of_the_receiver_takes_along(self):
        self.right(sender(THREE + told("delivered", "in doubt", "delivered") + counters(3, 2, in_doubt=1)),
                   receiver([got(1)], end=False) + receiver([got(3)], life=12))

    def test_finds_a_loss_that_no_kill_explains(self):
        many = [line for n in range(1, 6) for line in sent(n)]
        self.wrong("lost, from 2 to 2", sender(many + counters(5, 4, in_doubt=1)),
                   receiver([got(1), got(3)], end=False) + receiver([got(4), got(5)], life=12))

    def test_finds_a_loss_greater_than_a_kill_can_cause(self):
        many = [line for n in range(1, 20) for line in sent(n)]
        self.wrong("lost, from 2 to 18", sender(many + counters(19, 2, in_doubt=17)),
                   receiver([got(1)], end=False) + receiver([got(19)], life=12))

    def test_accepts_that_a_killed_sender_loses_its_outbox(self):
        self.right(sender(THREE, end=False), receiver([got(1)]))

    def test_finds_a_loss_in_the_middle_of_a_killed_senders_row(self):
        self.wrong("lost, from 2 to 2", sender(THREE, end=False), receiver([got(1), got(3)]))

    def test_demands_nothing_of_the_last_intent_of_a_killed_sender(self):
        cut = sent(1) + sent(2)[:1]
        self.right(sender(cut, end=False), receiver([got(1)]))
        self.right(sender(cut, end=False), receiver([got(1), got(2)]))

    def test_leaves_out_a_line_that_a_kill_cut_short(self):
        self.right(sender(sent(1), end=False) + "3000000000 inte", receiver([got(1)]))

    def test_finds_a_note_of_another_size(self):
        self.wrong("another size",
                   sender(["1000000000 intent to=b id=1 expire_s=0 octets=8", "1000000001 accepted to=b id=1"]
                          + told("delivered") + counters(1, 1)),
                   receiver([got(1, extra=" octets=7")]))

    def test_accepts_pictures_beside_notes(self):
        self.right(sender(sent(1) + told("delivered") + counters(1, 1) + pictured(1) + picture_counters(1)),
                   receiver([got(1), "3000000000 picture from=a life=10 id=1"]))

    def test_finds_a_lost_picture(self):
        self.wrong("pictures: a to b: 1 accepted notes lost",
                   sender(pictured(1) + picture_counters(1)), receiver([]))

    def test_finds_a_picture_delivered_twice(self):
        self.wrong("pictures: b: note 1 of a delivered twice",
                   sender(pictured(1) + picture_counters(1)),
                   receiver(["3000000000 picture from=a life=10 id=1", "3000000001 picture from=a life=10 id=1"]))

    def test_finds_a_picture_without_an_outcome(self):
        self.wrong("pictures: a to b: nothing was told of 1 accepted notes",
                   sender(pictured(1)[:-1] + picture_counters(1)),
                   receiver(["3000000000 picture from=a life=10 id=1"]))


if __name__ == "__main__":
    unittest.main()
