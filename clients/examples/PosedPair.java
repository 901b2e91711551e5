/* Two boxes, one turned by 45 degrees about z: do they meet? On Debian, with the message types of
 * share/fmb/lcmtypes and a running fmbd:
 *
 *     apt install liblcm-bin liblcm-java default-jdk-headless
 *     lcm-gen -j --jpath types /usr/local/share/fmb/lcmtypes/*.lcm
 *     javac -cp /usr/share/java/lcm.jar:types -d classes PosedPair.java
 *     java -Djava.net.preferIPv4Stack=true -cp /usr/share/java/lcm.jar:classes PosedPair
 *
 * prints "overlapping". */
import fmb_msgs.pair_query_t;
import fmb_msgs.pair_result_t;
import fmb_msgs.placement_t;
import java.security.SecureRandom;
import java.util.concurrent.LinkedBlockingQueue;
import java.util.concurrent.TimeUnit;
import lcm.lcm.LCM;

public final class PosedPair
{
    /** size: full edge lengths; orientation: w, x, y, z of any length, or none. */
    private static placement_t box(double[] size, double[] position, double... orientation)
    {
        placement_t out = new placement_t();
        out.dim = 3;
        out.num_frames = 1;
        out.shapes = new byte[] {placement_t.SHAPE_BOX};
        out.counts = new int[0];
        out.numbers = new double[] {0, 0, 0, size[0], size[1], size[2]}; // centre and size
        out.num_numbers = out.numbers.length;
        out.name = "";
        out.position = position;
        out.num_orientation = orientation.length;
        out.orientation = orientation;
        out.velocity = out.end_pose = new double[0];
        return out;
    }

    public static void main(String[] args) throws Exception
    {
        String url = System.getenv("LCM_DEFAULT_URL");
        LCM lcm = new LCM(url != null ? url : "udpm://239.255.76.67:7667?ttl=0");
        LinkedBlockingQueue<pair_result_t> results = new LinkedBlockingQueue<>();
        pair_query_t query = new pair_query_t();
        query.client_id = new SecureRandom().nextLong() >>> 11; // below 2^53
        query.a = box(new double[] {2, 1, 0.25}, new double[] {0, 0, 0.125});
        query.b = box(new double[] {0.5, 0.5, 1}, new double[] {1.25, 0, 0.625}, 0.92388, 0, 0, 0.382683);
        // The bus carries all clients' results; those of others are not decoded, since a damaged one
        // may take any memory. A busy service has to be queried again later. An exception would end
        // LCM's thread.
        lcm.subscribe("FMB_PAIR_RESULT", (bus, channel, bytes) -> {
            try {
                bytes.readLong(); // fingerprint
                bytes.readLong(); // utime
                if (bytes.readLong() != query.client_id)
                    return;
                bytes.reset();
                pair_result_t result = new pair_result_t(bytes);
                if (result.status != pair_result_t.STATUS_BUSY)
                    results.add(result);
            } catch (java.io.IOException | RuntimeException damaged) {
                return;
            }
        });
        // LCM loses datagrams: the same query is sent again until its result comes.
        pair_result_t result = null;
        for (int tries = 6; result == null && tries > 0; tries--) {
            lcm.publish("FMB_PAIR_QUERY", query);
            result = results.poll(500, TimeUnit.MILLISECONDS);
        }
        String[] verdicts = {"", "separated", "touching", "overlapping"};
        System.out.println(result == null ? "no fmbd answered"
                           : result.status == 0 ? verdicts[result.verdict] : result.detail);
        System.exit(result != null && result.status == 0 ? 0 : 1); // LCM's threads would live on
    }
}
