/* Sends the largest scene query that is served (63,900 bytes) from Java, and prints the counts of
 * verdicts and handles of its result. Exit code 0: it had a result. */

import fmb_msgs.placement_t;
import fmb_msgs.scene_query_t;
import fmb_msgs.scene_result_t;

import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;
import java.io.IOException;
import java.util.concurrent.BlockingQueue;
import java.util.concurrent.LinkedBlockingQueue;
import java.util.concurrent.TimeUnit;
import lcm.lcm.LCM;
import lcm.lcm.LCMEncodable;

public final class Largest
{
    /* 86 bytes, 186 for each cube and 4 for each pair. */
    private static final int CUBES = 343, PAIRS = 4, LARGEST = 63900, TRIES = 20;
    private static final long CLIENT_ID = 815;

    private static placement_t cube(int i)
    {
        placement_t cube = new placement_t();
        cube.body_id = 1 + i;
        cube.dim = 3;
        cube.num_frames = 1;
        cube.shapes = new byte[] {placement_t.SHAPE_CUBOID};
        cube.num_numbers = 12;
        cube.numbers = new double[] {0, 0, 0, 1 + i, 0, 0, 0, 1, 0, 0, 0, 1};
        cube.counts = new int[0];
        cube.name = "";
        cube.position = new double[] {0.75 * i, 0, 0};
        cube.orientation = cube.velocity = cube.end_pose = new double[0];
        return cube;
    }

    private static scene_query_t sceneQuery()
    {
        scene_query_t query = new scene_query_t();
        query.client_id = CLIENT_ID;
        query.label = "s";
        query.which = scene_query_t.PAIRS_LISTED;
        query.num_placements = CUBES;
        query.placements = new placement_t[CUBES];
        for (int i = 0; i < CUBES; i++)
            query.placements[i] = cube(i);
        query.num_indices = 2 * PAIRS;
        query.indices = new short[2 * PAIRS];
        for (int i = 0; i < 2 * PAIRS; i++)
            query.indices[i] = (short) (i / 2 + i % 2);
        query.ignored = new short[0];
        return query;
    }

    private static int size(LCMEncodable message) throws IOException
    {
        ByteArrayOutputStream bytes = new ByteArrayOutputStream();
        message.encode(new DataOutputStream(bytes));
        return bytes.size();
    }

    /* LCM loses datagrams: the query is sent until its result comes. */
    private static boolean run(LCM lcm) throws IOException, InterruptedException
    {
        BlockingQueue<String> results = new LinkedBlockingQueue<>();
        lcm.subscribe("FMB_SCENE_RESULT", (bus, channel, bytes) -> {
            try {
                scene_result_t result = new scene_result_t(bytes);
                results.add("status " + result.status + ", " + result.num_verdicts +
                            " verdicts, " + result.num_handle_bytes / 16 + " handles");
            } catch (IOException damaged) {
                results.add("damaged");
            }
        });
        scene_query_t scene = sceneQuery();
        if (size(scene) != LARGEST)
            return false;
        String result = null;
        for (int i = 0; i < TRIES && result == null; i++) {
            lcm.publish("FMB_SCENE_QUERY", scene);
            result = results.poll(500, TimeUnit.MILLISECONDS);
        }
        System.out.println(result);
        return result != null;
    }

    public static void main(String[] args) throws IOException, InterruptedException
    {
        String url = System.getenv("LCM_DEFAULT_URL");
        boolean usual = url == null || url.isEmpty();
        System.exit(run(new LCM(usual ? "udpm://239.255.76.67:7667?ttl=0" : url)) ? 0 : 1);
    }
}
