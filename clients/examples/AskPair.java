/* Queries the service on the bus, from Java: do a cube and a tetrahedron that moves towards it
 * meet, when and in which box? Then the same for the next stretch of time, with handles in place of
 * the frames that the service holds by then.
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
 * Arguments, which may be left out: the seconds of a stretch (1), and how often to send a
 * query before it is given up (6). The bus is that of LCM_DEFAULT_URL, or the usual one of this
 * host. Exit codes: 0 answered, 1 refused or no service answered, 2 wrong arguments. */

import fmb_msgs.pair_query_t;
import fmb_msgs.pair_result_t;
import fmb_msgs.placement_t;

import java.io.IOException;
import java.math.BigDecimal;
import java.math.MathContext;
import java.security.SecureRandom;
import java.util.Arrays;
import java.util.concurrent.BlockingQueue;
import java.util.concurrent.LinkedBlockingQueue;
import java.util.concurrent.TimeUnit;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;

public final class AskPair
{
    private static final String DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0";
    private static final String QUERY_CHANNEL = "FMB_PAIR_QUERY", RESULT_CHANNEL = "FMB_PAIR_RESULT";
    private static final byte[] NO_HANDLE = new byte[16];
    private static final long TIMEOUT_NS = TimeUnit.MILLISECONDS.toNanos(500);

    /* ---- A client of the service ----------------------------------------------------------- */

    /** For one thread. */
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

        /* Results go to all clients on the bus. The client's id follows the fingerprint of the type
         * and utime. */
        private boolean isMine(LCMDataInputStream bytes) throws IOException
        {
            boolean isResult = bytes.readLong() == pair_result_t.LCM_FINGERPRINT;
            bytes.readLong();
            boolean mine = isResult && bytes.readLong() == id;
            bytes.reset();
            return mine;
        }

        /* In LCM's thread, which an exception would end. Results of other clients are not decoded:
         * in a damaged one a count may be anything, and decoding takes that much memory. */
        private void take(LCMDataInputStream bytes)
        {
            try {
                if (isMine(bytes))
                    results.add(new pair_result_t(bytes));
            } catch (IOException | RuntimeException damaged) {
                return;
            }
        }

        /* The result with this number, or null once the deadline has passed. Second results of
         * earlier queries are ignored. */
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

        /* LCM loses datagrams without notice, and a busy service has to be queried again later: so
         * the same query is sent again after each time-out, with the same number. Null: there was
         * no result. */
        private pair_result_t send(pair_query_t query) throws InterruptedException
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

        private pair_result_t queryOnce(Body a, Body b, double duration) throws InterruptedException
        {
            pair_query_t query = new pair_query_t();
            query.duration = duration;
            query.want = pair_query_t.WANT_BOX;
            query.a = a.placement();
            query.b = b.placement();
            return send(query);
        }

        /** Do two bodies meet within the duration? A service that was started anew, or needed the
         * space, does not hold a body any more: then the bodies are sent whole again. Null: there
         * was no result. */
        pair_result_t queryPair(Body a, Body b, double duration) throws InterruptedException
        {
            pair_result_t result = queryOnce(a, b, duration);
            if (result != null && result.status == pair_result_t.STATUS_UNKNOWN_BODY) {
                a.handle = b.handle = NO_HANDLE;
                result = queryOnce(a, b, duration);
            }
            if (result != null && result.status == pair_result_t.STATUS_OK) {
                a.keep(result.handle_a);
                b.keep(result.handle_b);
            }
            return result;
        }
    }

    /* ---- A scene, and its answers ---------------------------------------------------------- */

    static final class Body
    {
        final long id;
        final byte shape;
        final double[] numbers; // of its only frame: origin in body coordinates, then components
        final double[] position, velocity;
        byte[] handle = NO_HANDLE; // of shape and numbers, once the service holds them

        Body(long id, byte shape, double[] numbers, double[] position, double[] velocity)
        {
            this.id = id;
            this.shape = shape;
            this.numbers = numbers;
            this.position = position;
            this.velocity = velocity;
        }

        /* A result has the handles of bodies that were sent whole. */
        void keep(byte[] newHandle)
        {
            if (!Arrays.equals(newHandle, NO_HANDLE))
                handle = newHandle;
        }

        placement_t placement()
        {
            boolean whole = Arrays.equals(handle, NO_HANDLE);
            placement_t placement = new placement_t();
            placement.body_id = id;
            placement.handle = handle;
            placement.dim = position.length;
            placement.shapes = whole ? new byte[] {shape} : new byte[0];
            placement.num_frames = placement.shapes.length;
            placement.numbers = whole ? numbers : new double[0];
            placement.num_numbers = placement.numbers.length;
            placement.position = position;
            placement.orientation = new double[0]; // not turned
            placement.velocity = velocity;
            placement.num_velocity = velocity.length;
            return placement;
        }

        void move(double seconds)
        {
            for (int axis = 0; axis < velocity.length; axis++)
                position[axis] += seconds * velocity[axis];
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

    private static int queryScene(Client client, String url, double duration)
        throws InterruptedException
    {
        double[] numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
        Body cube = new Body(1, placement_t.SHAPE_CUBOID, numbers, new double[] {0, 0, 0},
                             new double[0]);
        Body tetrahedron = new Body(2, placement_t.SHAPE_TETRAHEDRON, numbers,
                                    new double[] {2, 0, 0}, new double[] {-1.5, 0, 0});
        for (int i = 0; i < 2; i++) {
            pair_result_t result = client.queryPair(cube, tetrahedron, duration);
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
            return queryScene(new Client(url, tries), url, duration);
        } catch (IOException | IllegalArgumentException failed) {
            return fail(1, "cannot open the bus " + url + ": " + failed.getMessage());
        }
    }

    public static void main(String[] args) throws InterruptedException
    {
        System.exit(run(args)); // LCM's threads would live on
    }
}
