/* Two boxes, one turned by 45 degrees about z: do they meet? Over plain LCM, once, without
 * repeating what the bus loses (AskPair.java does). Types, classes and fmbd as for AskPair.java. Prints
 * "overlapping". */
import fmb_msgs.pair_query_t;
import fmb_msgs.pair_result_t;
import fmb_msgs.placement_t;
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
        out.numbers = new double[] {0, 0, 0, size[0], size[1], size[2]}; // centre and size
        out.num_numbers = out.numbers.length;
        out.position = position;
        out.num_orientation = orientation.length;
        out.orientation = orientation;
        out.velocity = new double[0];
        return out;
    }

    public static void main(String[] args) throws Exception
    {
        String url = System.getenv("LCM_DEFAULT_URL");
        LCM lcm = new LCM(url != null ? url : "udpm://239.255.76.67:7667?ttl=0");
        LinkedBlockingQueue<pair_result_t> results = new LinkedBlockingQueue<>();
        pair_query_t query = new pair_query_t();
        query.client_id = System.nanoTime() >>> 11;
        query.a = box(new double[] {2, 1, 0.25}, new double[] {0, 0, 0.125});
        query.b = box(new double[] {0.5, 0.5, 1}, new double[] {1.25, 0, 0.625}, 0.92388, 0, 0, 0.382683);
        lcm.subscribe("FMB_PAIR_RESULT", (bus, channel, bytes) -> {
            try {
                results.add(new pair_result_t(bytes));
            } catch (java.io.IOException damaged) {
                return;
            }
        });
        lcm.publish("FMB_PAIR_QUERY", query);
        String[] names = {"", "separated", "touching", "overlapping"};
        pair_result_t result = results.poll(1, TimeUnit.SECONDS);
        while (result != null && result.client_id != query.client_id)
            result = results.poll(1, TimeUnit.SECONDS);
        System.out.println(result == null ? "no fmbd answered"
                           : result.status == 0 ? names[result.verdict] : result.detail);
        System.exit(result != null && result.status == 0 ? 0 : 1); // LCM's threads would live on
    }
}
