-- Queries two cubes whole, then by the handles of the result: prints both verdicts. Then by the
-- handle of a body that no service holds: prints the status.
unpack = unpack or table.unpack -- what lcm-gen writes is for Lua 5.1

local lcm = require 'lcm'
local pair_query_t = require 'fmb_msgs.pair_query_t'
local pair_result_t = require 'fmb_msgs.pair_result_t'
local placement_t = require 'fmb_msgs.placement_t'

local bus = lcm.lcm.new(os.getenv('LCM_DEFAULT_URL') or 'udpm://239.255.76.67:7667?ttl=0')
local query, result = pair_query_t:new(), nil
bus:subscribe('FMB_PAIR_RESULT', function(_, bytes) result = pair_result_t.decode(bytes) end)

local function send()
    result = nil
    query.sequence_number = query.sequence_number + 1
    for _ = 1, 20 do
        bus:publish('FMB_PAIR_QUERY', query:encode())
        bus:handle_timeout(500)
        if result then return result end
    end
    error('no result')
end

local function by_handle(placement, handle)
    placement.handle = handle
    placement.num_frames, placement.shapes, placement.num_numbers, placement.numbers = 0, {}, 0, {}
end

query.client_id = 815
for id, name in ipairs({'a', 'b'}) do
    local cube = placement_t:new()
    cube.body_id, cube.dim = id, 3
    cube.num_frames, cube.shapes = 1, {placement_t.SHAPE_BOX}
    cube.num_numbers, cube.numbers = 6, {0, 0, 0, 1, 1, id}
    cube.position = {0, 0, 1.5 * (id - 1)}
    query[name] = cube
end
local whole = send()
print(whole.status, whole.verdict)
by_handle(query.a, whole.handle_a)
by_handle(query.b, whole.handle_b)
query.b.position = {0, 0, 1} -- they touched at 0.5; now it reaches down to 0
print(send().status, result.verdict)
query.b.handle[1] = (query.b.handle[1] + 1) % 256
print(send().status == pair_result_t.STATUS_UNKNOWN_BODY and 'unknown body' or result.status)
