-- Two boxes, one turned by 45 degrees about z: do they meet? On Debian, with the message types of
-- share/fmb/lcmtypes and a running fmbd:
--
--     apt install liblcm-bin liblcm-lua lua5.2
--     lcm-gen -l --lpath types /usr/local/share/fmb/lcmtypes/*.lcm
--     LUA_PATH='types/?.lua;;' lua5.2 posed_pair.lua
--
-- prints "overlapping".
unpack = unpack or table.unpack -- lcm-gen writes Lua 5.1
local lcm = require 'lcm'
local pair_query_t = require 'fmb_msgs.pair_query_t'
local pair_result_t = require 'fmb_msgs.pair_result_t'
local placement_t = require 'fmb_msgs.placement_t'

-- size: full edge lengths; orientation: w, x, y, z of any length, or none.
local function box(size, position, orientation)
    local out = placement_t:new()
    out.dim = 3
    out.num_frames, out.shapes = 1, {placement_t.SHAPE_BOX}
    out.num_numbers, out.numbers = 6, {0, 0, 0, size[1], size[2], size[3]}
    out.position = position
    out.num_orientation, out.orientation = #orientation, orientation
    return out
end

local bus = lcm.lcm.new(os.getenv('LCM_DEFAULT_URL') or 'udpm://239.255.76.67:7667?ttl=0')
local query = pair_query_t:new()
for _, byte in ipairs({io.open('/dev/urandom', 'rb'):read(6):byte(1, 6)}) do
    query.client_id = query.client_id * 256 + byte -- random, so that no other client has it
end
query.a = box({2, 1, 0.25}, {0, 0, 0.125}, {})
query.b = box({0.5, 0.5, 1}, {1.25, 0, 0.625}, {0.92388, 0, 0, 0.382683})

-- The bus carries all clients' results. A busy service has to be queried again later.
local verdicts, answer = {'separated', 'touching', 'overlapping'}, nil
bus:subscribe('FMB_PAIR_RESULT', function(_, bytes)
    local readable, result = pcall(pair_result_t.decode, bytes)
    if readable and result.client_id == query.client_id
        and result.status ~= pair_result_t.STATUS_BUSY then
        answer = result.status == 0 and verdicts[result.verdict] or result.detail
    end
end)

-- LCM loses datagrams: the same query is sent again until its result comes.
local tries = 6
while not answer and tries > 0 do
    local start = os.time()
    bus:publish('FMB_PAIR_QUERY', query:encode())
    while not answer and os.time() - start < 2 and bus:handle_timeout(500) do end
    tries = tries - 1
end
print(answer or 'no fmbd answered')
os.exit(answer ~= nil)
