/* Names by the numbers of the messages. NO_VERDICT: there is no result. */
const VERDICTS = ["not decided", "separated", "touching", "overlapping"];
const NO_VERDICT = -1, SEPARATED = 1, TOUCHING = 2, OVERLAPPING = 3;

function verdictName(verdict) {
    return verdict < 0 ? "no answer" : VERDICTS[verdict];
}
