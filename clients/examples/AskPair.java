/* Asks the service on the bus, from Java, whether a cube and a tetrahedron that comes at it meet,
 * when and in which box; then the same for the next stretch of time, with keys in place of the
 * components that the service holds by then.
 *
 * By hand, on Debian, with the message types that 'make install' puts into share/fmb/lcmtypes (in
 * the sources they are in msgs/):
 *
 *     apt install liblcm-bin liblcm-java default-jdk-headless
 *     lcm-gen -j --jpath types /usr/local/share/fmb/lcmtypes/*.lcm
 *     javac -cp /usr/share/java/lcm.jar:types -d classes AskPair.java
 *     fmbd &
 *     java -Djava.net.preferIPv4Stack=true -cp /usr/share/java/lcm.jar:classes AskPair
 *
 * prints
 *
 *     overlapping from 0.666667 to 1 s, box (0.5 0 0) to (1 1 1)
 *     overlapping from 0 to 1 s, box (0 0 0) to (1 1 1)
 *
 * Arguments, which may be left out: the seconds of a stretch (1), and how often to ask before
 * giving up (6). The bus is that of LCM_DEFAULT_URL, or the usual one of this host. Exit codes: 0
 * answered, 1 refused or nobody answered, 2 wrong arguments. */

import fmb_msgs.frame_t;
import fmb_msgs.pair_query_t;
import fmb_msgs.pair_result_t;

import java.io.IOException;
import java.math.BigDecimal;
import java.math.MathContext;
import java.security.SecureRandom;
import java.util.concurrent.BlockingQueue;
import java.util.concurrent.LinkedBlockingQueue;
import java.util.concurrent.TimeUnit;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;

public final class AskPair
{
    private static final String DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0";
    private static final String QUERY_CHANNEL = "FMB_PAIR_QUERY", RESULT_CHANNEL = "FMB_PAIR_RESULT";
    private static final long TIMEOUT_NS = TimeUnit.MILLISECONDS.toNanos(500);

    /* ---- A client of the service ----------------------------------------------------------- */

    /** To be asked from one thread. */
    static final class Client
    {
        private final LCM lcm;
        private final int tries;
        private final long id = new SecureRandom().nextLong() >>> 11; // below 2^53
        private final BlockingQueue<pair_result_t> results = new LinkedBlockingQueue<>();
        private long number = 0;

        /** tries: how often a query is sent before it is given up, at least once. */
        Client(String url, int tries) throws IOException
        {
            this.tries = tries;
            lcm = new LCM(url);
            lcm.subscribe(RESULT_CHANNEL, (bus, channel, bytes) -> take(bytes));
        }

        /* Results go to everybody on the bus. Whose one is stands in front, behind the fingerprint
         * of the type and utime. */
        private boolean isMine(LCMDataInputStream bytes) throws IOException
        {
            boolean isResult = bytes.readLong() == pair_result_t.LCM_FINGERPRINT;
            bytes.readLong();
            boolean mine = isResult && bytes.readLong() == id;
            bytes.reset();
            return mine;
        }

        /* In LCM's thread, which an exception would end. Others' results are not decoded: where one
         * is damaged, a count in it may be anything, and decoding takes that much memory. */
        private void take(LCMDataInputStream bytes)
        {
            try {
                if (isMine(bytes))
                    results.add(new pair_result_t(bytes));
            } catch (IOException | RuntimeException damaged) {
                return;
            }
        }

        /* The result with this number, or null once the deadline has passed. Second answers to
         * earlier queries are passed over. */
        private pair_result_t resultUntil(long deadline) throws InterruptedException
        {
            for (;;) {
                pair_result_t result =
                    results.poll(deadline - System.nanoTime(), TimeUnit.NANOSECONDS);
                if (result == null || result.sequence_number == number)
                    return result;
            }
        }

        private static boolean isBusy(pair_result_t result)
        {
            return result != null && result.status == pair_result_t.STATUS_BUSY;
        }

        /* LCM loses datagrams without a word, and a busy service wants to be asked again later: so
         * the same query goes out again after each time-out, with the same number. Null: there was
         * no result. */
        private pair_result_t ask(pair_query_t query) throws InterruptedException
        {
            pair_result_t refusal = null;
            number++;
            query.utime = System.currentTimeMillis() * 1000;
            query.client_id = id;
            query.sequence_number = number;
            for (int i = 0; i < tries; i++) {
                lcm.publish(QUERY_CHANNEL, query);
                long deadline = System.nanoTime() + TIMEOUT_NS;
                pair_result_t result = resultUntil(deadline);
                while (isBusy(result)) {
                    refusal = result;
                    result = resultUntil(deadline);
                }
                if (result != null)
                    return result;
            }
            return refusal;
        }

        private pair_result_t askOnce(Body a, Body b, double duration) throws InterruptedException
        {
            pair_query_t query = new pair_query_t();
            query.duration = duration;
            query.want = pair_query_t.WANT_BOX;
            query.a = a.frame();
            query.b = b.frame();
            return ask(query);
        }

        /** Do two bodies meet within the duration? A key dies with the service, or when the service
         * needs the room, or gets other components under the same id from any client: then the
         * bodies are sent whole again. Null: there was no result. */
        pair_result_t askPair(Body a, Body b, double duration) throws InterruptedException
        {
            pair_result_t result = askOnce(a, b, duration);
            if (result != null && result.status == pair_result_t.STATUS_UNKNOWN_BODY) {
                a.key = b.key = 0;
                result = askOnce(a, b, duration);
            }
            if (result != null && result.status == pair_result_t.STATUS_OK) {
                a.key = result.key_a;
                b.key = result.key_b;
            }
            return result;
        }
    }

    /* ---- A scene, and its answers ---------------------------------------------------------- */

    static final class Body
    {
        final long id;
        final int shape;
        final double[] components, origin, velocity;
        long key = 0; // that the service gave for the components, if it did: it stands for them

        Body(long id, int shape, double[] components, double[] origin, double[] velocity)
        {
            this.id = id;
            this.shape = shape;
            this.components = components;
            this.origin = origin;
            this.velocity = velocity;
        }

        frame_t frame()
        {
            frame_t frame = new frame_t();
            frame.body_id = id;
            frame.key = key;
            frame.shape = shape;
            frame.dim = origin.length;
            frame.origin = origin;
            frame.components = key == 0 ? components : new double[0];
            frame.num_components = frame.components.length;
            frame.velocity = velocity;
            frame.num_velocity = velocity.length;
            return frame;
        }

        void move(double seconds)
        {
            for (int axis = 0; axis < velocity.length; axis++)
                origin[axis] += seconds * velocity[axis];
        }
    }

    /** Six digits, without zeros at the end. */
    private static String text(double number)
    {
        if (Double.isInfinite(number))
            return Double.toString(number);
        return new BigDecimal(number, new MathContext(6)).stripTrailingZeros().toPlainString();
    }

    private static String text(double[] numbers, int from, int to)
    {
        StringBuilder text = new StringBuilder();
        for (int i = from; i < to; i++)
            text.append(i == from ? "" : " ").append(text(numbers[i]));
        return text.toString();
    }

    private static String verdictText(int verdict)
    {
        switch (verdict) {
        case pair_result_t.VERDICT_SEPARATED: return "separated";
        case pair_result_t.VERDICT_TOUCHING: return "touching";
        case pair_result_t.VERDICT_OVERLAPPING: return "overlapping";
        default: return "verdict " + verdict;
        }
    }

    private static String text(pair_result_t result)
    {
        String text = verdictText(result.verdict);
        int dim = result.num_box / 2;
        if (result.num_contact == 2)
            text += " from " + text(result.contact[0]) + " to " + text(result.contact[1]) + " s";
        if (dim > 0)
            text += ", box (" + text(result.box, 0, dim) + ") to (" +
                    text(result.box, dim, 2 * dim) + ")";
        return text;
    }

    private static int fail(int code, String what)
    {
        System.err.println("AskPair: " + what);
        return code;
    }

    private static int askScene(Client client, String url, double duration)
        throws InterruptedException
    {
        double[] edges = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        Body cube = new Body(1, frame_t.SHAPE_CUBOID, edges, new double[] {0, 0, 0}, new double[0]);
        Body tetrahedron = new Body(2, frame_t.SHAPE_TETRAHEDRON, edges, new double[] {2, 0, 0},
                                    new double[] {-1.5, 0, 0});
        for (int i = 0; i < 2; i++) {
            pair_result_t result = client.askPair(cube, tetrahedron, duration);
            if (result == null)
                return fail(1, "no fmbd answered on channel " + RESULT_CHANNEL + " of " + url +
                                   ": start one with 'fmbd &'");
            if (result.status != pair_result_t.STATUS_OK)
                return fail(1, "refused with status " + result.status + ": " + result.detail);
            System.out.println(text(result));
            tetrahedron.move(duration);
        }
        return 0;
    }

    private static int run(String[] args) throws InterruptedException
    {
        double duration;
        int tries;
        try {
            duration = args.length > 0 ? Double.parseDouble(args[0]) : 1;
            tries = args.length > 1 ? Integer.parseInt(args[1]) : 6;
        } catch (NumberFormatException noNumber) {
            tries = 0;
            duration = 0;
        }
        if (tries < 1 || args.length > 2)
            return fail(2, "usage: AskPair [SECONDS [TRIES]]");
        String set = System.getenv("LCM_DEFAULT_URL");
        String url = set == null || set.isEmpty() ? DEFAULT_URL : set;
        try {
            return askScene(new Client(url, tries), url, duration);
        } catch (IOException | IllegalArgumentException failed) {
            return fail(1, "cannot open the bus " + url + ": " + failed.getMessage());
        }
    }

    public static void main(String[] args) throws InterruptedException
    {
        System.exit(run(args)); // LCM's threads would live on
    }
}
